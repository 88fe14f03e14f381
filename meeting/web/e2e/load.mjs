// SPDX-License-Identifier: Apache-2.0
// Meetings under load: a real Mosquitto, trackers of the program, browsers without drawing (meeting/docs/cluster.md).
//   TELEMIME_PROGRAM=build/release/telemime node meeting/web/e2e/load.mjs [--meetings 1] [--people 8] [--watchers 8] [--rate 30]
//     [--seconds 600] [--processes 4] [--json FILE]
// Exit code 1: a bound is broken.

import { fork } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { cpus } from "node:os";
import { parseArgs } from "node:util";
import { launch } from "#e2e/process";
import { startBroker } from "../mock/broker.mjs";

const MEDIAN = 10; // ms, of the delivery
const P95 = 40; // ms
const GONE = 1000; // ms without a frame: the page lets the avatar rest
const GROWTH = { broker: 2, trackers: 8, browsers: 25 }; // MB after the warm-up: of all, of all, of each process
const FINE = 10; // as in load_page.mjs
const CLOCK_TICKS = 100; // a second, of /proc

const options = Object.fromEntries(
  Object.entries(
    parseArgs({
      options: {
        meetings: { type: "string", default: "1" },
        people: { type: "string", default: "8" },
        watchers: { type: "string", default: "8" },
        rate: { type: "string", default: "30" },
        seconds: { type: "string", default: "600" },
        processes: { type: "string", default: "4" },
        json: { type: "string" },
      },
    }).values,
  ).map(([k, v]) => [k, k === "json" ? v : Number(v)]),
);
const { meetings, people, watchers, rate, seconds } = options;
const program = process.env.TELEMIME_PROGRAM;
if (!program) throw new Error("TELEMIME_PROGRAM names no program");
const two = (n) => String(n).padStart(2, "0");
const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

const memory = (pid) => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]) / 1024; // MB
/** Seconds of processor time. */
function processor(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / CLOCK_TICKS;
}
const sum = (numbers) => numbers.reduce((a, b) => a + b, 0);
const median = (numbers) => [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)];

// -- the meetings

const password = "load";
const all = Array.from({ length: meetings }, (_, r) => {
  const name = `meeting${two(r)}`;
  const ids = Array.from({ length: people }, (_, i) => `p${two(i + 1)}`);
  return { topic: `r/load/${name}`, ids, name };
});
const broker = await startBroker(
  all.flatMap(({ topic, ids, name }) => [
    ...ids.map((id) => ({
      user: `${name}.${id}`,
      password,
      read: [`${topic}/#`],
      write: [`${topic}/p/${id}/#`],
    })),
    { user: `${name}.watch`, password, read: [`${topic}/#`], write: [] },
  ]),
);
const failures = [];
const fail = (words) => {
  console.log(`FAILED: ${words}`);
  failures.push(words);
};

// The trackers of a meeting are one process. Each is the program's own sender with its own connection.
const port = new URL(broker.tcp).port;
const trackers = await Promise.all(
  all.map(({ ids, name }) => {
    const address = (id) => `mqtt://${name}.${id}:${password}@127.0.0.1:${port}/load/${name}?name=${id}`;
    return launch(program, ["meeting", "people", ...ids.map(address), "--rate", String(rate)]);
  }),
);

const browsers = all.flatMap(({ topic, ids, name }) =>
  Array.from({ length: watchers }, () => ({
    url: broker.ws,
    user: `${name}.watch`,
    password,
    topic,
    people: ids,
  })),
);
const pages = await Promise.all(
  Array.from({ length: Math.min(options.processes, browsers.length) }, async (_, i) => {
    const child = fork(new URL("load_page.mjs", import.meta.url));
    const mine = browsers.filter((_, b) => b % options.processes === i);
    await new Promise((resolve, reject) => {
      child.on("message", (m) => {
        if (m.ready) resolve();
        if (m.closed) fail("a browser was disconnected");
        if (m.streams) child.report = m;
      });
      child.on("exit", () => reject(new Error("a browser cannot join")));
      child.send({ open: mine });
    });
    child.ended = new Promise((resolve) => child.on("exit", resolve));
    return child;
  }),
);

// -- the measurement

const processes = {
  broker: [broker.pid],
  trackers: trackers.map((t) => t.pid),
  browsers: pages.map((p) => p.pid),
};
/** What `measure` gives for the processes of each group. */
const ofGroups = (measure) =>
  Object.fromEntries(Object.entries(processes).map(([group, pids]) => [group, measure(pids)]));
const cpuTimes = () => ofGroups((pids) => sum(pids.map(processor)));
const warmUp = Math.min(120, seconds / 3);
await wait(3000); // until all trackers are in
pages.forEach((p) => p.send({ measure: true }));
const begun = performance.now();
const cpuBefore = cpuTimes();
const samples = [];
while (performance.now() - begun < seconds * 1000) {
  await wait(Math.min(1000, seconds * 100));
  samples.push({ at: (performance.now() - begun) / 1000, ...ofGroups((pids) => pids.map(memory)) });
}
const lasted = (performance.now() - begun) / 1000;
const cpuAfter = cpuTimes();
const coresOf = (group) => [group, (cpuAfter[group] - cpuBefore[group]) / lasted];
const cores = Object.fromEntries(Object.keys(processes).map(coresOf));
pages.forEach((p) => p.send({ stop: true }));
await Promise.all(pages.map((p) => p.ended));
await Promise.all(trackers.map((t) => t.end("SIGINT")));
await broker.close();

// -- the result

const reports = pages.map((p) => p.report);
const delays = reports[0].delays.map((_, bin) => sum(reports.map((r) => r.delays[bin])));
const deliveries = sum(reports.map((r) => r.deliveries));
/** The upper end of the histogram's bin, ms. */
function quantile(share) {
  let rest = share * deliveries;
  for (let bin = 0; bin < delays.length; bin++) {
    rest -= delays[bin];
    if (rest <= 0) return (bin + 1) / FINE;
  }
  return Infinity;
}
const streams = reports.flatMap((r) => r.streams);
const total = (key) => sum(streams.map((s) => s[key]));
const lost = streams.filter((s) => s.gap > GONE || s.sessions !== 1);
const unreadable = sum(reports.map((r) => r.unreadable));
const rest = samples.filter((s) => s.at >= warmUp);
const quarter = Math.max(1, Math.floor(rest.length / 4));
/** Growth of each process of a group, MB: the last quarter of the samples compared with the first. */
const growth = (group) => {
  const middle = (some, i) => median(some.map((s) => s[group][i]));
  return rest[0][group].map((_, i) => middle(rest.slice(-quarter), i) - middle(rest.slice(0, quarter), i));
};
const grown = {
  broker: growth("broker")[0],
  trackers: sum(growth("trackers")),
  browsers: Math.max(...growth("browsers")),
};
const end = samples.at(-1);
const result = {
  meetings,
  people,
  watchers,
  rate,
  seconds: Math.round(lasted),
  deliveries,
  perSecond: Math.round(deliveries / lasted),
  framesOfTracker: total("count") / streams.length / lasted,
  p50: quantile(0.5),
  p95: quantile(0.95),
  p99: quantile(0.99),
  max: Math.max(...reports.map((r) => r.worst)),
  lostFrames: total("lost"),
  lateFrames: total("late"),
  longestGap: Math.max(...streams.map((s) => s.gap)),
  lostTrackers: lost.length,
  unreadable,
  brokerCores: cores.broker,
  trackerCores: cores.trackers,
  browserCores: cores.browsers,
  memory: { broker: end.broker[0], trackers: sum(end.trackers), browsers: sum(end.browsers) },
  grown,
};
const n = (x, digits = 1) => x.toFixed(digits);
console.log(`${meetings} meeting(s) of ${people} trackers at ${rate} Hz and ${watchers} browsers in ${pages.length} processes, ${result.seconds} s, ${cpus().length} cores
deliveries      ${deliveries}, ${result.perSecond} a second; ${n(result.framesOfTracker)} a second of each tracker in each browser
delivery, ms    median ${n(result.p50)}   95 % ${n(result.p95)}   99 % ${n(result.p99)}   longest ${n(result.max)}
frames          ${result.lostFrames} lost, ${result.lateFrames} out of order, ${unreadable} unreadable; longest gap ${n(result.longestGap, 0)} ms
trackers        ${result.lostTrackers} of ${streams.length} streams lost (more than ${GONE} ms without a frame, or a new session)
processor       broker ${n(100 * cores.broker)} %, trackers ${n(100 * cores.trackers)} %, browsers ${n(100 * cores.browsers)} % of a core
memory, MB      broker ${n(result.memory.broker)} (${n(grown.broker)} more than after ${n(warmUp, 0)} s), trackers ${n(result.memory.trackers)} (${n(grown.trackers)}), browsers ${n(result.memory.browsers)} (${n(grown.browsers)} the one that grew most)`);
for (const t of trackers) {
  for (const line of t.output.out.split("\n").slice(1)) {
    if (line && !/ 0 dropped$/.test(line)) console.log(`tracker: ${line}`);
  }
}
if (deliveries === 0) fail("nothing was delivered");
if (lost.length > 0) fail(`${lost.length} trackers were lost, the first is ${lost[0].participant}`);
if (!(result.p50 <= MEDIAN)) fail(`the median is more than ${MEDIAN} ms`);
if (!(result.p95 <= P95)) fail(`95 % take more than ${P95} ms`);
for (const [what, bound] of Object.entries(GROWTH)) {
  if (!(grown[what] <= bound))
    fail(`memory of ${what} is not flat: ${n(grown[what])} MB, more than ${bound}`);
}
if (options.json) writeFileSync(options.json, `${JSON.stringify({ ...result, failures }, null, 2)}\n`);
process.exit(failures.length > 0 ? 1 : 0);
