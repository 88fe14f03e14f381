// SPDX-License-Identifier: Apache-2.0
// A mock of `telemime meeting`: a Mosquitto, the page at /room, and /room/enter. As a program it adds synthetic people:
//   node meeting/web/mock/meeting.mjs [--port 7080] [--avatars DIR] [--people 5] [--seats 8]

import { randomBytes } from "node:crypto";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { parseArgs } from "node:util";
import mqtt from "mqtt";
import { boxAvatar } from "#mock/avatar";
import { startBroker as startMosquitto } from "./broker.mjs";
import { loadCodec, startPerson } from "./people.mjs";

const DIST = fileURLToPath(new URL("../../../web/dist/", import.meta.url));
const TYPES = {
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript",
  ".css": "text/css",
  ".svg": "image/svg+xml",
};
const LOOKS = ["plain", "casual", "office", "summer", "robot"];
const secret = () => randomBytes(24).toString("base64url");

/** Allows the page's own files, its broker, and avatars by HTTPS; no inline scripts or styles, no eval. */
const policy = (broker) =>
  "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; font-src 'self'; " +
  `worker-src 'self'; connect-src 'self' blob: data: https: ${broker}; ` +
  "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/** Avatars by name: one of boxes for all looks, or files of a folder. */
function avatarsOf(folder) {
  const files = folder ? readdirSync(folder).filter((f) => f.endsWith(".vrm")) : [];
  const boxes = boxAvatar();
  return new Map([
    ...LOOKS.map((look) => [look, boxes]),
    ...files.map((f) => [f.slice(0, -4), readFileSync(join(folder, f))]),
  ]);
}

/** `accounts`: participants' accounts; the first is a chair's. `startBroker`: startCluster of cluster.mjs for another one. */
export async function startMeeting({
  port = 0,
  seats = 8,
  accounts = seats,
  avatars = null,
  title = "Blue room",
  startBroker = startMosquitto,
} = {}) {
  const topic = "r/mock/blue";
  const ids = Array.from({ length: accounts }, (_, i) => `p${String(i + 1).padStart(2, "0")}`);
  const account = (participant, ...write) => {
    const keys = { user: `blue.${participant}`, password: secret() };
    return { participant, ...keys, read: [`${topic}/#`], write };
  };
  const all = [
    ...ids.map((id, i) => account(id, `${topic}/p/${id}/#`, ...(i === 0 ? [`${topic}/room`] : []))),
    account("watch"),
    account("service", `${topic}/#`),
  ];
  const of = new Map(all.map((a) => [a.participant, a]));
  const broker = await startBroker(all, topic);
  const invites = { speak: secret(), watch: secret(), chair: secret() };
  const tokens = new Map(); // return token -> participant
  const taken = new Set();
  const files = avatarsOf(avatars);

  function enter({ invite, return: token, watch }) {
    const back = tokens.get(token);
    const speaks = invite === invites.speak || invite === invites.chair || (!invite && back);
    if (!speaks && invite !== invites.watch) return [403, {}];
    if (watch || !speaks) return [200, { ...keysOf("watch"), participant: null, roles: ["watch"] }];
    // The first seat is the chair's.
    const free = ids.find((id, i) => !taken.has(id) && (invite === invites.chair) === (i === 0));
    const id = back ?? free;
    if (!id) return [409, {}];
    taken.add(id);
    const mine = back ? token : secret();
    tokens.set(mine, id);
    const roles = ["speak", "board", ...(id === ids[0] ? ["chair"] : [])];
    return [200, { ...keysOf(id), participant: id, roles, return: mine }];
  }
  const keysOf = (id) => {
    const { user, password } = of.get(id);
    return { user, password, mqtt: broker.ws, topic, looks: LOOKS };
  };

  const server = createServer((request, response) => {
    const url = new URL(request.url, "http://localhost");
    const send = (code, type, data) => {
      response.writeHead(code, {
        "content-type": type,
        "content-security-policy": policy(broker.ws),
        "x-content-type-options": "nosniff",
        "referrer-policy": "no-referrer",
      });
      response.end(data);
    };
    if (url.pathname === "/room/enter" && request.method === "POST") {
      let body = "";
      request.on("data", (d) => {
        body += d;
        if (body.length > 4096) request.destroy();
      });
      request.on("end", () => {
        let question = null;
        try {
          question = JSON.parse(body);
        } catch {
          // refused below
        }
        const [code, answer] = question && typeof question === "object" ? enter(question) : [400, {}];
        send(code, "application/json", JSON.stringify(answer));
      });
      return undefined;
    }
    const avatar = /^\/avatars\/([\w-]+)\.vrm$/.exec(url.pathname);
    if (avatar) {
      const data = files.get(avatar[1]) ?? files.get(avatar[1].replace(/-light$/, ""));
      return data ? send(200, "model/gltf-binary", data) : send(404, "text/plain", "no such avatar");
    }
    const name = url.pathname === "/room" ? "/meeting.html" : url.pathname;
    const path = join(DIST, normalize(name));
    if (!path.startsWith(DIST) || !existsSync(path) || !extname(path))
      return send(404, "text/plain", "not here");
    return send(200, TYPES[extname(path)] ?? "application/octet-stream", readFileSync(path));
  });
  await new Promise((resolve) => server.listen(port, "127.0.0.1", resolve));

  // The service of the meeting publishes its state again when the broker was restarted.
  let meeting = { title, seats, epoch: 1, chairs: [ids[0]], locked: false };
  const service = mqtt.connect(broker.tcp, {
    protocolVersion: 4,
    clientId: `service-${randomBytes(4).toString("hex")}`,
    username: of.get("service").user,
    password: of.get("service").password,
    reconnectPeriod: 300,
  });
  service.on("error", () => {});
  service.on("message", (_, payload) => {
    const stored = JSON.parse(payload.toString());
    if (stored.epoch >= meeting.epoch) meeting = stored;
  });
  await new Promise((resolve) => {
    service.on("connect", () => {
      service
        .publishAsync(`${topic}/room`, JSON.stringify({ v: 1, ...meeting }), { qos: 1, retain: true })
        .then(() => service.subscribeAsync(`${topic}/room`, { qos: 1 }))
        .then(resolve, () => {});
    });
  });
  const url = `http://localhost:${server.address().port}/room`;
  return {
    broker,
    topic,
    url,
    invites,
    service,
    link: (role) => `${url}#k=${invites[role]}`,
    /** An unused account for a tracker, the last one first. */
    takeAccount() {
      const id = [...ids].reverse().find((i) => !taken.has(i));
      taken.add(id);
      return of.get(id);
    },
    async close() {
      await service.endAsync(true);
      server.closeAllConnections();
      server.close();
      await broker.close();
    },
  };
}

if (import.meta.url === pathToFileURL(process.argv[1] ?? "").href) {
  const { values: options } = parseArgs({
    options: {
      port: { type: "string", default: "7080" },
      avatars: { type: "string" },
      people: { type: "string", default: "5" },
      seats: { type: "string", default: "8" },
    },
  });
  const people = Number(options.people);
  const meeting = await startMeeting({
    port: Number(options.port),
    seats: Number(options.seats),
    accounts: people + 8,
    avatars: options.avatars ?? null,
  });
  const codec = await loadCodec();
  const names = ["Ana", "Bo", "Chidi", "Dara", "Emeka", "Fumiko", "Goran", "Hanna", "Ines", "Jun"];
  for (let i = 0; i < people; i++) {
    await startPerson(
      { ...meeting, account: meeting.takeAccount(), codec },
      {
        name: names[i % names.length],
        avatar: { look: LOOKS[i % LOOKS.length] },
        gesture: ["wave", "open", "idle", "point"][i % 4],
        rate: Math.min(30, Math.max(5, 300 / people)),
        phase: i,
      },
    );
  }
  for (const role of Object.keys(meeting.invites)) console.log(`to ${role}: ${meeting.link(role)}`);
  process.on("SIGINT", () => void meeting.close().then(() => process.exit(0)));
}
