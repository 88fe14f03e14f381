// SPDX-License-Identifier: Apache-2.0
// Browsers of load.mjs that only watch: mqtt.js over WebSocket and the page's own decoder, without the drawing. A child
// process with some of them, controlled by messages of its parent.

import mqtt from "mqtt";
import { loadCodec } from "../mock/people.mjs";

const FINE = 10; // bins of the histogram in a millisecond
const LONGEST = 2000; // ms; the last bin holds all that is longer
const delays = new Uint32Array(FINE * LONGEST);
let worst = 0;
let deliveries = 0;
let unreadable = 0;
let measuring = false;
/** What each browser has received of each tracker since the measurement began. */
const streams = [];
const clients = [];

const now = () => Number(process.hrtime.bigint() / 1000n); // us, CLOCK_MONOTONIC, as the trackers' capture times

function received(stream, frame, at) {
  const delay = (at - Number(frame.captured)) / 1000;
  delays[Math.min(delays.length - 1, Math.max(0, Math.floor(delay * FINE)))]++;
  worst = Math.max(worst, delay);
  deliveries++;
  if (frame.session !== stream.session) {
    stream.sessions++;
    stream.session = frame.session;
    stream.next = frame.sequence;
  }
  if (frame.sequence < stream.next) stream.late++;
  else {
    stream.lost += frame.sequence - stream.next;
    stream.next = frame.sequence + 1;
  }
  stream.count++;
  if (stream.at) stream.gap = Math.max(stream.gap, (at - stream.at) / 1000);
  stream.at = at;
}

function browse({ url, user, password, topic, people }, decodeFrame) {
  const mine = new Map(
    people.map((p) => [
      `${topic}/p/${p}/pose`,
      { participant: p, session: 0, sessions: 0, next: 0, count: 0, lost: 0, late: 0, gap: 0, at: 0 },
    ]),
  );
  streams.push(mine);
  const client = mqtt.connect(url, {
    protocolVersion: 4,
    clean: true,
    clientId: `watch-${Math.random().toString(16).slice(2, 10).padEnd(8, "0")}`,
    username: user,
    password,
    keepalive: 10,
    reconnectPeriod: 0,
    queueQoSZero: false,
  });
  clients.push(client);
  client.on("message", (name, payload) => {
    const at = now();
    if (!name.endsWith("/pose")) return;
    const frame = decodeFrame(payload);
    const stream = mine.get(name);
    if (!frame || !stream) unreadable++;
    else if (measuring) received(stream, frame, at);
  });
  return new Promise((resolve, reject) => {
    client.on("error", reject);
    client.on("close", () => process.send({ closed: true }));
    client.on("connect", () => client.subscribeAsync(`${topic}/#`, { qos: 1 }).then(resolve, reject));
  });
}

process.on("message", async (m) => {
  if (m.open) {
    const { decodeFrame } = await loadCodec();
    await Promise.all(m.open.map((b) => browse(b, decodeFrame)));
    process.send({ ready: true });
  } else if (m.measure) {
    measuring = true;
  } else if (m.stop) {
    measuring = false;
    const at = now();
    for (const mine of streams)
      for (const s of mine.values()) s.gap = s.at ? Math.max(s.gap, (at - s.at) / 1000) : Infinity;
    process.send({
      delays: Array.from(delays),
      worst,
      deliveries,
      unreadable,
      streams: streams
        .flatMap((mine) => [...mine.values()])
        .map((s) => ({ ...s, gap: Math.min(s.gap, 1e9) })),
    });
    clients.forEach((c) => c.removeAllListeners("close"));
    await Promise.all(clients.map((c) => c.endAsync(true)));
    process.disconnect();
  }
});
