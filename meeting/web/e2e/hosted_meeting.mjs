// SPDX-License-Identifier: Apache-2.0
// The real `telemime meeting`, in the shape of mock/meeting.mjs. TELEMIME_MOSQUITTO names its broker.

import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launch } from "#e2e/process";

const ROLES = ["speak", "watch", "chair"];

/** The links by their roles, once the meeting is open. */
function linksIn(output) {
  const links = ROLES.map((role) => [role, new RegExp(`^to ${role}: (\\S+)$`, "m").exec(output)?.[1]]);
  return output.includes("MQTT at port") && links.every(([, link]) => link) && Object.fromEntries(links);
}

/** All ports of the program are free ones. */
export async function startHostedMeeting(command, { title = "Blue room" } = {}) {
  const folder = mkdtempSync(join(tmpdir(), "telemime-hosted-"));
  const ports = ["--port", "0", "--mqtt-port", "0", "--ws-port", "0"];
  const mosquitto = process.env.TELEMIME_MOSQUITTO ? ["--mosquitto", process.env.TELEMIME_MOSQUITTO] : [];
  const program = await launch(command, ["meeting", "--title", title, ...ports, ...mosquitto], {
    env: { XDG_STATE_HOME: folder }, // no meetings of a user
    ready: linksIn,
  });
  const links = program.found;
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
    spawnSync("ps", ["--ppid", String(program.pid), "-o", "pid="], { encoding: "utf8" })
      .stdout.trim()
      .split(/\s+/)
      .filter(Boolean)
      .map(Number);
  return {
    output: program.output,
    folder,
    url,
    topic: watcher.topic,
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
      again() {}, // the program restarts it
    },
    /** A new account, for a tracker. */
    takeAccount: () => enter({ invite: invites.speak }),
    async close() {
      await program.end();
      rmSync(folder, { recursive: true, force: true });
    },
  };
}
