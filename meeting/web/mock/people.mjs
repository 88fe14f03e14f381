// SPDX-License-Identifier: Apache-2.0
// Trackers for a meeting: synthetic people whose motion goes to the broker in the format of meeting/docs/protocol.md.

import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import mqtt from "mqtt";
import { transformWithEsbuild } from "vite";
import { BODY, poseAt } from "#mock/motion";

/** The page's own codec, in Node. */
export async function loadCodec() {
  const source = fileURLToPath(new URL("../src/frame.ts", import.meta.url));
  const { code } = await transformWithEsbuild(readFileSync(source, "utf8"), source);
  return import(`data:text/javascript,${encodeURIComponent(code)}`);
}

const json = (m) => JSON.stringify({ v: 1, ...m });
const clock = () => performance.now() * 1000; // us

/**
 * A person who moves; `gesture` as in motion.mjs. `poseOf(captured)` is the truth at that moment of its clock (us).
 * `rate`: frames a second.
 */
export async function startPerson(
  { broker, topic, account, codec },
  { name, gesture = "wave", seat = null, avatar = { look: "plain" }, rate = 30, phase = 0 },
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
  const timer = setInterval(() => {
    if (!person.paused && client.connected) client.publish(`${base}/pose`, Buffer.from(frame(clock())));
  }, 1000 / rate);
  return Object.assign(person, {
    client,
    base,
    poseOf,
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
