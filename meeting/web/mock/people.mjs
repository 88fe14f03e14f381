// SPDX-License-Identifier: Apache-2.0
// Trackers for a meeting: synthetic people whose motion goes to the broker in the format of meeting/docs/protocol.md.

import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import mqtt from "mqtt";
import { transformWithEsbuild } from "vite";
import { BODY, poseAt } from "#mock/motion";

/** The page's own codec, in Node. */
export async function loadCodec() {
  const modules = ["frame.ts", "detail.ts"].map(async (name) => {
    const source = fileURLToPath(new URL(`../src/${name}`, import.meta.url));
    const { code } = await transformWithEsbuild(readFileSync(source, "utf8"), source);
    return import(`data:text/javascript,${encodeURIComponent(code)}`);
  });
  return Object.assign({}, ...(await Promise.all(modules)));
}

/** Degrees of an index finger, and the jaw (0 to 1), of a person who talks with the hands; `t` in s. */
const bendAt = (t) => Math.round(-50 + 40 * Math.sin(2 * t));
const jawAt = (t) => 0.5 + 0.5 * Math.sin(2.6 * t);
/** Places in a detail (meeting/docs/protocol.md): the left index finger's middle bone, `jawOpen` and `aa`. */
const MIDDLE_OF_INDEX = 11;
const JAW_OPEN = 24;
const AA = 5;

const json = (m) => JSON.stringify({ v: 1, ...m });
const clock = () => performance.now() * 1000; // us

/**
 * A person who moves; `gesture` as in motion.mjs. `poseOf(captured)` is the truth at that moment of its clock (us).
 * `rate`: frames a second. `detailed`: with fingers and face.
 */
export async function startPerson(
  { broker, topic, account, codec },
  { name, gesture = "wave", seat = null, avatar = { look: "plain" }, rate = 30, phase = 0, detailed = false },
) {
  const { participant, user, password } = account;
  const base = `${topic}/p/${participant}`;
  const session = 1 + Math.floor(Math.random() * 65535);
  const person = { participant, session, sequence: 0, tracked: true, paused: false };
  const client = mqtt.connect(broker.tcp, {
    protocolVersion: 4,
    clientId: `${participant}-${Math.random().toString(16).slice(2, 10).padEnd(8, "0")}`,
    username: user,
    password,
    keepalive: 5,
    reconnectPeriod: 300,
    will: { topic: `${base}/presence`, payload: json({ here: false, session }), qos: 1, retain: true },
  });
  client.on("error", () => {}); // followed by a further try
  const publish = (what, payload, retain = true) =>
    client.publishAsync(`${base}/${what}`, payload, { qos: 1, retain });
  const announce = async () => {
    await publish("presence", json({ here: true, session }));
    await publish("state", json({ session, kind: "tracker", name, seat, avatar, stature: 1.7, bones: BODY }));
  };
  await new Promise((resolve) => {
    client.on("connect", () => announce().then(resolve, () => {}));
  });
  const poseOf = (captured) => poseAt(captured / 1e6 + phase, gesture);
  const frame = (captured) => {
    const { hips, bones } = poseOf(captured);
    const named = codec.BONES.map((bone, i) => ({ bone: i, rotation: bones[bone], confidence: 12 }));
    return codec.encodeFrame({
      tracked: person.tracked,
      still: false,
      session,
      sequence: person.sequence++,
      captured: BigInt(Math.round(captured)),
      hips,
      bones: person.tracked ? named.filter((b) => b.rotation) : [],
    });
  };
  const detail = (captured) => {
    const t = captured / 1e6 + phase;
    const fingers = new Array(50).fill(0);
    fingers[MIDDLE_OF_INDEX] = bendAt(t);
    const arkit = new Array(52).fill(0);
    arkit[JAW_OPEN] = Math.round(255 * jawAt(t));
    const vrm = new Array(17).fill(0);
    vrm[AA] = arkit[JAW_OPEN];
    const { session, sequence } = person;
    const face = { confidence: 255, gaze: [0, 0], arkit, vrm };
    return codec.encodeDetail({ session, sequence: sequence - 1, fingers, face });
  };
  const timer = setInterval(() => {
    if (person.paused || !client.connected) return;
    const captured = clock();
    client.publish(`${base}/pose`, Buffer.from(frame(captured)));
    if (detailed && person.tracked) client.publish(`${base}/pose`, Buffer.from(detail(captured)));
  }, 1000 / rate);
  return Object.assign(person, {
    client,
    base,
    poseOf,
    bendOf: (captured) => bendAt(captured / 1e6 + phase),
    jawOf: (captured) => jawAt(captured / 1e6 + phase),
    frame,
    say: (id, text) => publish("chat", json({ id: `${session}-${id}`, text }), false),
    async leave() {
      clearInterval(timer);
      await publish("presence", json({ here: false, session }));
      await publish("state", "");
      await client.endAsync();
    },
    /** Loses the connection. */
    drop() {
      clearInterval(timer);
      client.stream.destroy();
      client.end(true);
    },
  });
}
