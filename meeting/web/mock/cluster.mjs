// SPDX-License-Identifier: Apache-2.0
// Three real nodes of nats-server with accounts for one meeting, configured by scripts/cluster.py, and a load balancer for
// browsers.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { connect, createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import mqtt from "mqtt";
import { launch } from "#e2e/process";

const SERVER = process.env.TELEMIME_NATS_SERVER ?? "nats-server";
const SCRIPT =
  process.env.TELEMIME_MEETING_CLUSTER ?? fileURLToPath(new URL("../../scripts/cluster.py", import.meta.url));
const PATIENCE = 60000; // ms until a node accepts clients: the nodes elect a leader

/** A TCP server that forwards each connection to the next of `ports` that accepts it; `used` lists their indices. */
async function startBalancer(ports) {
  const used = [];
  const open = new Set();
  let next = 0;
  const server = createServer((client) => {
    open.add(client);
    client.on("close", () => open.delete(client));
    client.on("error", () => {});
    const forward = (tries) => {
      if (tries === 0) return client.destroy();
      const place = next++ % ports.length;
      const node = connect(ports[place], "127.0.0.1");
      let reached = false;
      node.on("connect", () => {
        reached = true;
        used.push(place);
        client.pipe(node).pipe(client);
      });
      node.on("error", () => {});
      node.on("close", () => (reached ? client.destroy() : forward(tries - 1)));
      client.on("close", () => node.destroy());
      return undefined;
    };
    forward(ports.length);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return {
    used,
    port: server.address().port,
    close() {
      for (const s of open) s.destroy();
      server.close();
    },
  };
}

/** Waits until the node accepts an account. */
async function acceptsClients(url, { user, password }) {
  const until = performance.now() + PATIENCE;
  for (;;) {
    const options = {
      protocolVersion: 4,
      username: user,
      password,
      reconnectPeriod: 0,
      connectTimeout: 5000,
    };
    const client = mqtt.connect(url, options);
    const accepted = await new Promise((resolve) => {
      client.on("connect", () => resolve(true));
      client.on("error", () => resolve(false));
      client.on("close", () => resolve(false));
    });
    client.end(true);
    if (accepted) return;
    if (performance.now() > until) throw new Error(`nats-server accepts nobody at ${url}`);
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
}

/**
 * The accounts of mock/meeting.mjs get the passwords of the cluster. `tcp` is the last node's; `ws` forwards to the first two in
 * turn. Nodes are counted from 0.
 */
export async function startCluster(accounts, topic) {
  const root = mkdtempSync(join(tmpdir(), "telemime-cluster-"));
  const folder = join(root, "cluster");
  const [, tenant, meeting] = topic.split("/");
  const participants = accounts.filter((a) => /^p\d\d$/.test(a.participant)).length;
  execFileSync("python3", [
    ...[SCRIPT, "make", folder, "--loopback", "--tenant", tenant, "--room", meeting],
    ...["--participants", String(participants)],
  ]);
  const keyOf = (id) => JSON.parse(readFileSync(join(folder, "keys", `${id}.json`), "utf8"));
  for (const a of accounts) Object.assign(a, keyOf(a.participant));
  const { nodes } = JSON.parse(readFileSync(join(folder, "cluster.json"), "utf8"));
  const servers = [];
  const start = async (n) => (servers[n] = await launch(SERVER, ["-c", join(folder, nodes[n].config)]));
  const kill = (n) => servers[n].end("SIGKILL");
  const ready = (n) => acceptsClients(nodes[n].mqtt, keyOf("watch"));
  await Promise.all(nodes.map((_, n) => start(n)));
  await Promise.all(nodes.map((_, n) => ready(n)));
  const balancer = await startBalancer(nodes.slice(0, 2).map((n) => Number(new URL(n.ws).port)));
  return {
    tcp: nodes[2].mqtt,
    ws: `ws://127.0.0.1:${balancer.port}/mqtt`,
    /** The node of each connection of a browser. */
    nodes: balancer.used,
    /** Ends a node without closing its connections. */
    kill,
    /** Starts it again with its stored messages. */
    async again(n) {
      await start(n);
      await ready(n);
    },
    async close() {
      balancer.close();
      await Promise.all(nodes.map((_, n) => kill(n)));
      rmSync(root, { recursive: true, force: true });
    },
  };
}
