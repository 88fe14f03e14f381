// SPDX-License-Identifier: Apache-2.0
// A real Mosquitto with accounts for one meeting, as its own child process on free ports of this computer.

import { pbkdf2Sync, randomBytes } from "node:crypto";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { connect, createServer } from "node:net";
import { tmpdir, userInfo } from "node:os";
import { join } from "node:path";
import { launch } from "#e2e/process";

const MOSQUITTO = process.env.TELEMIME_MOSQUITTO ?? "mosquitto";
const PATIENCE = 20000; // ms until it listens

function freePort() {
  return new Promise((resolve, reject) => {
    const s = createServer();
    s.on("error", reject);
    s.listen(0, "127.0.0.1", () => {
      const { port } = s.address();
      s.close(() => resolve(port));
    });
  });
}

const listens = (port) =>
  new Promise((resolve) => {
    const s = connect(port, "127.0.0.1");
    s.on("connect", () => {
      s.destroy();
      resolve(true);
    });
    s.on("error", () => resolve(false));
  });

/** One line of Mosquitto's password file. */
function account(user, password) {
  const salt = randomBytes(12);
  const hash = pbkdf2Sync(password, salt, 101, 64, "sha512");
  return `${user}:$7$101$${salt.toString("base64")}$${hash.toString("base64")}`;
}

/** `accounts`: [{ user, password, read: [topic], write: [topic] }]. */
export async function startBroker(accounts) {
  const folder = mkdtempSync(join(tmpdir(), "telemime-broker-"));
  const file = (name, lines) => {
    const path = join(folder, name);
    writeFileSync(path, lines.join("\n") + "\n", { mode: 0o600 });
    return path;
  };
  const [tcp, ws] = [await freePort(), await freePort()];
  const config = file("mosquitto.conf", [
    "per_listener_settings false",
    `user ${userInfo().username}`,
    "allow_anonymous false",
    `password_file ${file(
      "passwords",
      accounts.map((a) => account(a.user, a.password)),
    )}`,
    `acl_file ${file(
      "acl",
      accounts.flatMap((a) => [
        `user ${a.user}`,
        ...a.read.map((t) => `topic read ${t}`),
        ...a.write.map((t) => `topic write ${t}`),
      ]),
    )}`,
    "persistence false",
    "max_packet_size 65536",
    `listener ${tcp} 127.0.0.1`,
    "protocol mqtt",
    `listener ${ws} 127.0.0.1`,
    "socket_domain ipv4", // without it Mosquitto 2.0.11 listens for WebSockets at all addresses
    "protocol websockets",
  ]);
  let mosquitto = null;

  async function start() {
    mosquitto = await launch(MOSQUITTO, ["-c", config]);
    let over = false;
    void mosquitto.ended.then(() => (over = true));
    const until = performance.now() + PATIENCE;
    while (!((await listens(tcp)) && (await listens(ws)))) {
      if (over || performance.now() > until) throw new Error(`Mosquitto: ${mosquitto.output.err}`);
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
  }
  await start();
  return {
    tcp: `mqtt://127.0.0.1:${tcp}`,
    ws: `ws://127.0.0.1:${ws}`,
    get pid() {
      return mosquitto.pid;
    },
    /** Ends without closing its connections. */
    kill: () => mosquitto.end("SIGKILL"),
    /** Starts on the same ports, without retained messages. */
    again: start,
    async close() {
      await mosquitto.end();
      rmSync(folder, { recursive: true, force: true });
    },
  };
}
