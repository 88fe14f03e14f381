// SPDX-License-Identifier: Apache-2.0
// Plays the program: serves dist/, avatars and recordings, and speaks docs/live-protocol.md with a synthetic person.
//   node mock/server.mjs [--port 7070] [--avatars DIR] [--start empty_room|tracking|...]
// GET /mock/set?phase=..&gesture=idle|wave|point|open&lost=0|1|auto&say=words&silent=0|1 steers it, for tests.

import { readFileSync, readdirSync, existsSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { WebSocketServer } from "ws";
import { boxAvatar } from "./avatar.mjs";
import { scene } from "./jpeg.mjs";
import { BODY, CAMERA, poseAt, seen } from "./motion.mjs";
import { toVrm0 } from "./to-vrm0.mjs";

const { values: options } = parseArgs({
  options: {
    port: { type: "string", default: "7070" },
    avatars: { type: "string" },
    start: { type: "string", default: "opening" },
  },
});

const DIST = fileURLToPath(new URL("../dist/", import.meta.url));
const FPS = 25;
const TYPES = {
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript",
  ".css": "text/css",
  ".svg": "image/svg+xml",
  ".vrm": "model/gltf-binary",
};
const CSP =
  "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; " +
  "connect-src 'self' blob: data:; font-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

const avatars = new Map();
if (options.avatars) {
  for (const f of readdirSync(options.avatars)
    .filter((f) => f.endsWith(".vrm"))
    .sort()) {
    avatars.set(f.slice(0, -4), readFileSync(join(options.avatars, f)));
  }
} else {
  avatars.set("boxes", boxAvatar());
}
for (const [name, data] of [...avatars]) {
  if (data.includes('"VRMC_vrm"')) avatars.set(`${name}-0`, toVrm0(data));
}

const start = performance.now();
const stamp = () => performance.now() - start;
const state = {
  phase: options.start,
  roomEmpty: false,
  since: stamp(),
  gesture: null,
  lost: "auto",
  silent: false,
  frame: 0,
  recording: null,
  recordings: [{ number: 1, seconds: 12, frames: 300, files: files(300) }],
  outputs: [
    { url: "vmc://localhost:39539", state: "sending", words: "", sent: 0, dropped: 0, receivers: 1 },
    {
      url: "bap+tcp://player.local:4150",
      state: "waiting",
      words: "nobody answers there; trying again in 5 s",
      sent: 0,
      dropped: 12,
      receivers: 0,
    },
  ],
  latencies: [],
  received: [],
};

function files(frames) {
  const size = { bvh: 420, glb: 310, vrma: 260, csv: 900, trc: 380, jsonl: 3100 };
  return Object.entries(size).map(([end, n]) => ({
    name: `${end === "jsonl" || end === "csv" ? "pose" : "motion"}.${end}`,
    bytes: 1200 + n * frames,
  }));
}

function enter(phase) {
  state.phase = phase;
  state.since = stamp();
  if (phase === "tracking") broadcast(body());
  status();
}

const body = () => ({ type: "body", stature: 1.7, scale_from: "words", bones: BODY });

/** What happens by itself. */
function advance() {
  const t = (stamp() - state.since) / 1000;
  if (state.phase === "opening" && t > 1) enter("empty_room");
  else if (state.phase === "background" && t > 2.5) enter("person");
  else if (state.phase === "person" && t > 4) enter("tracking");
  else if (state.phase === "tracking" && isLost()) enter("lost");
  else if (state.phase === "lost" && !isLost()) enter("tracking");
}

const isLost = () => state.lost === "1" || (state.lost === "auto" && (stamp() / 1000) % 20 > 16.5);

const WORDS = {
  opening: "Camera 0 is being opened.",
  empty_room: "Somebody is in the picture.",
  background: "Picture 12 of 25 of the room.",
  person: "Arms are too close to the body.",
  tracking: "Tracking you.",
  lost: "You are outside the picture. Come back to go on.",
  stopped: "The camera gives no pictures. Is it plugged in?",
  ended: "The film is over.",
};

const sockets = new Set();
function broadcast(m) {
  const text = JSON.stringify(m);
  for (const s of sockets) s.send(text);
}

function status() {
  const sorted = state.latencies.slice(-200).sort((a, b) => a - b);
  const at = (p) => Math.round(sorted[Math.min(sorted.length - 1, Math.floor(p * sorted.length))] * 10) / 10;
  const wobble = (v) => Math.round((v + 0.06 * v * Math.sin(stamp() / 900 + v)) * 10) / 10;
  broadcast({
    type: "status",
    phase: state.phase,
    room_empty: state.roomEmpty,
    words: WORDS[state.phase] ?? "",
    fps: { input: 25, tracked: state.phase === "tracking" ? wobble(24.6) : 0 },
    dropped: 3,
    ms: { wait: wobble(1), features: wobble(8.1), search: wobble(22), total: wobble(33) },
    latency: sorted.length ? { median: at(0.5), p95: at(0.95) } : null,
    cpu: wobble(1.1),
    outputs: state.outputs,
    recording: state.recording && {
      seconds: (stamp() - state.recording) / 1000,
      frames: Math.round(((stamp() - state.recording) / 1000) * FPS),
    },
    recordings: state.recordings,
  });
}

function command(socket, m) {
  const bad = () =>
    socket.send(JSON.stringify({ type: "message", level: "error", words: "That message is not known." }));
  if (m.type !== "drawn" && m.type !== "ping") state.received.push(m);
  switch (m.type) {
    case "guide":
      if (m.step === "empty" || m.step === "skip") {
        state.roomEmpty = m.step === "empty";
        enter("background");
      } else if (m.step === "again") enter("empty_room");
      else bad();
      break;
    case "recalibrate":
      enter("person");
      break;
    case "output":
      if (typeof m.add === "string") {
        if (!/^(vmc|ws|bap\+tcp|bap\+serve):\/\//.test(m.add)) {
          socket.send(
            JSON.stringify({
              type: "message",
              level: "error",
              words: `Nothing can be sent to ${m.add}: the part before :// is not known.`,
            }),
          );
        } else
          state.outputs.push({
            url: m.add,
            state: "sending",
            words: "",
            sent: 0,
            dropped: 0,
            receivers: null,
          });
      } else state.outputs = state.outputs.filter((o) => o.url !== m.remove);
      status();
      break;
    case "record":
      if (m.on && !state.recording) state.recording = stamp();
      else if (!m.on && state.recording) {
        const seconds = (stamp() - state.recording) / 1000;
        const frames = Math.round(seconds * FPS);
        const number = 1 + Math.max(0, ...state.recordings.map((r) => r.number));
        state.recordings.push({ number, seconds, frames, files: files(frames) });
        state.recording = null;
        broadcast({ type: "message", level: "info", words: `Recording ${number} is ready to be saved.` });
      }
      status();
      break;
    case "forget":
      state.recordings = state.recordings.filter((r) => r.number !== m.recording);
      status();
      break;
    case "pictures":
      socket.pictures = m.on;
      socket.half = m.half === true;
      break;
    case "drawn":
      state.latencies.push(stamp() - m.stamp);
      break;
    case "ping":
      socket.send(JSON.stringify({ type: "pong", id: m.id, stamp: stamp() }));
      break;
    default:
      bad();
  }
}

function frame() {
  advance();
  if (state.silent || ["opening", "stopped", "ended"].includes(state.phase)) return;
  const frame = ++state.frame;
  const at = stamp();
  const t = at / 1000;
  const person = poseAt(t, state.gesture);
  const view = seen(person, t);
  const visible = !["empty_room", "background", "lost"].includes(state.phase);
  const head = Buffer.alloc(16);
  head[0] = 1;
  head.writeUInt32LE(frame, 4);
  head.writeDoubleLE(at, 8);
  const picture = Buffer.concat([head, scene(visible ? view.pixels : null, t)]);
  for (const s of sockets) {
    if (s.pictures && !(s.half && frame % 2) && s.bufferedAmount < 1e6) s.send(picture);
  }
  const base = { type: "pose", frame, time: t, stamp: at };
  // The tracker takes its time.
  setTimeout(() => {
    if (state.phase === "lost") broadcast({ ...base, state: "lost" });
    if (state.phase !== "tracking") return;
    for (const o of state.outputs) if (o.state === "sending") o.sent++;
    broadcast({
      ...base,
      state: "tracking",
      ...person,
      ...view,
      second_mode: 0.1 + 0.25 * Math.max(0, Math.sin(t)),
      F: 0.12 + 0.03 * Math.sin(1.7 * t),
      D_C: 1.8 + 0.4 * Math.sin(2.3 * t),
    });
  }, 33);
}

const hello = {
  type: "hello",
  protocol: 1,
  version: "0.1.0",
  input: "0",
  live: true,
  camera: CAMERA,
  looks: [...avatars.keys()],
  formats: ["jsonl", "csv", "bvh", "glb", "vrma", "trc"],
  senders: [
    { scheme: "vmc", example: "vmc://localhost:39539", summary: "Avatar programs: VSeeFace, Warudo, VNyan" },
    { scheme: "bap+tcp", example: "bap+tcp://localhost:4150", summary: "MPEG-4 players that listen" },
    { scheme: "bap+serve", example: "bap+serve://:4150", summary: "MPEG-4 players that ask for it" },
    { scheme: "ws", example: "ws://localhost:9000", summary: "Your own program: what this page gets" },
  ],
};

const server = createServer((request, response) => {
  const url = new URL(request.url, "http://localhost");
  const send = (code, type, data) => {
    response.writeHead(code, {
      "content-type": type,
      "content-security-policy": CSP,
      "x-content-type-options": "nosniff",
    });
    response.end(data);
  };
  const avatar = /^\/avatars\/([\w-]+)\.vrm$/.exec(url.pathname);
  if (url.pathname === "/mock/set") {
    const q = url.searchParams;
    if (q.has("gesture")) state.gesture = q.get("gesture") || null;
    if (q.has("lost")) state.lost = q.get("lost");
    if (q.has("silent")) state.silent = q.get("silent") === "1";
    if (q.has("say")) broadcast({ type: "message", level: q.get("level") ?? "info", words: q.get("say") });
    if (q.has("phase")) enter(q.get("phase"));
    return send(200, "application/json", JSON.stringify({ phase: state.phase, received: state.received }));
  }
  if (avatar) {
    const data = avatars.get(avatar[1]) ?? avatars.get(avatar[1].replace(/-light$/, ""));
    return data ? send(200, "model/gltf-binary", data) : send(404, "text/plain", "no such avatar");
  }
  if (/^\/recordings\/\d+\/[\w.-]+$/.test(url.pathname))
    return send(200, "application/octet-stream", "mock\n");
  const path = join(DIST, normalize(url.pathname === "/" ? "/index.html" : url.pathname));
  if (!path.startsWith(DIST) || !existsSync(path) || !extname(path))
    return send(404, "text/plain", "not here");
  return send(200, TYPES[extname(path)] ?? "application/octet-stream", readFileSync(path));
});

const ws = new WebSocketServer({ server, path: "/ws" });
ws.on("connection", (socket) => {
  socket.pictures = true;
  sockets.add(socket);
  socket.on("close", () => sockets.delete(socket));
  socket.on("error", () => sockets.delete(socket));
  socket.on("message", (data, binary) => {
    let m = null;
    try {
      m = binary ? null : JSON.parse(data.toString());
    } catch {
      // answered below
    }
    command(socket, m ?? {});
  });
  socket.send(JSON.stringify(hello));
  if (["tracking", "lost"].includes(state.phase)) socket.send(JSON.stringify(body()));
  status();
});

setInterval(frame, 1000 / FPS);
setInterval(status, 500);
server.listen(Number(options.port), "127.0.0.1", () => {
  console.log(`mock on http://localhost:${server.address().port}`);
});
