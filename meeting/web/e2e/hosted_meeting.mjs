// SPDX-License-Identifier: Apache-2.0
// The real `telemime meeting`, in the shape of mock/meeting.mjs. TELEMIME_MOSQUITTO names its broker.

import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const ROLES = ["speak", "watch", "chair"];

/** `args`: further options of the program. All of its ports are free ones. */
export async function startHostedMeeting(program, { title = "Blue room", args = [] } = {}) {
  const folder = mkdtempSync(join(tmpdir(), "telemime-hosted-"));
  const ports = ["--port", "0", "--mqtt-port", "0", "--ws-port", "0"];
  const mosquitto = process.env.TELEMIME_MOSQUITTO ? ["--mosquitto", process.env.TELEMIME_MOSQUITTO] : [];
  const child = spawn(program, ["meeting", "--title", title, ...ports, ...mosquitto, ...args], {
    stdio: ["ignore", "pipe", "pipe"],
    env: { ...process.env, XDG_STATE_HOME: folder }, // nobody's own meetings
  });
  const heard = { out: "", err: "" };
  child.stdout.on("data", (d) => (heard.out += d));
  child.stderr.on("data", (d) => (heard.err += d));
  const ended = new Promise((resolve) => child.on("exit", resolve));
  const links = await new Promise((resolve, reject) => {
    child.stdout.on("data", () => {
      const found = ROLES.map((role) => new RegExp(`^to ${role}: (\\S+)$`, "m").exec(heard.out)?.[1]);
      if (found.every(Boolean) && heard.out.includes("MQTT at port"))
        resolve(Object.fromEntries(ROLES.map((role, i) => [role, found[i]])));
    });
    void ended.then((code) => reject(new Error(`the program ended (${code}): ${heard.err}`)));
  });
  const url = links.speak.split("#")[0];
  const invites = Object.fromEntries(ROLES.map((role) => [role, links[role].split("#k=")[1]]));
  const enter = async (question) => {
    const answer = await fetch(new URL("/room/enter", url), {
      method: "POST",
      headers: { "content-type": "application/json" },
      body: JSON.stringify({ v: 1, ...question }),
    });
    if (!answer.ok) throw new Error(`/room/enter answers ${answer.status}`);
    return answer.json();
  };
  const watcher = await enter({ invite: invites.watch, watch: true });
  const brokers = () =>
    spawnSync("ps", ["--ppid", String(child.pid), "-o", "pid="], { encoding: "utf8" })
      .stdout.trim()
      .split(/\s+/)
      .filter(Boolean)
      .map(Number);
  return {
    program: child,
    heard,
    ended,
    folder,
    url,
    topic: watcher.topic,
    asked: [],
    invites,
    enter,
    link: (role) => links[role],
    broker: {
      tcp: watcher.tcp,
      ws: watcher.mqtt,
      get pid() {
        return brokers()[0];
      },
      kill() {
        this.signal("SIGKILL");
      },
      signal(name) {
        for (const pid of brokers()) process.kill(pid, name);
      },
      again() {}, // by itself
    },
    /** A newcomer's, for a tracker. */
    takeAccount: () => enter({ invite: invites.speak }),
    async close() {
      child.kill("SIGTERM");
      await ended;
      rmSync(folder, { recursive: true, force: true });
    },
  };
}
