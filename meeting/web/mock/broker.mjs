// SPDX-License-Identifier: Apache-2.0
// A real Mosquitto with accounts for one meeting, as its own child process on free ports of this computer.

import { spawn } from "node:child_process";
import { pbkdf2Sync, randomBytes } from "node:crypto";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { connect, createServer } from "node:net";
import { tmpdir, userInfo } from "node:os";
import { join } from "node:path";

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
  let child = null;
  let ended = null;
  let heard = "";

  async function start() {
    heard = "";
    child = spawn(MOSQUITTO, ["-c", config], {
      stdio: ["ignore", "pipe", "pipe"],
      env: { ...process.env, PATH: `${process.env.PATH}:/usr/sbin` },
    });
    let over = null;
    child.stdout.on("data", (d) => (heard += d));
    child.stderr.on("data", (d) => (heard += d));
    ended = new Promise((resolve) => {
      child.on("exit", (code) => resolve((over = `ended with ${code}`)));
      child.on("error", (e) => resolve((over = String(e))));
    });
    const until = performance.now() + PATIENCE;
    while (!((await listens(tcp)) && (await listens(ws)))) {
      if (over || performance.now() > until) throw new Error(`Mosquitto: ${over ?? "is silent"}: ${heard}`);
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
  }
  async function stop(signal = "SIGTERM") {
    child.kill(signal);
    await ended;
  }
  await start();
  return {
    tcp: `mqtt://127.0.0.1:${tcp}`,
    ws: `ws://127.0.0.1:${ws}`,
    get pid() {
      return child.pid;
    },
    /** Dies without a word. */
    kill: () => stop("SIGKILL"),
    /** On the same ports, with nothing that it knew. */
    again: start,
    async close() {
      await stop();
      rmSync(folder, { recursive: true, force: true });
    },
  };
}
