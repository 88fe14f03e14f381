// SPDX-License-Identifier: Apache-2.0
// Measures the time from the camera to the drawn avatar, with the bundled clip as the camera and a real Chromium:
//   TELEMIME_PROGRAM=build/release/telemime node web/e2e/latency.mjs [seconds]

import { readFileSync } from "node:fs";
import { Listener } from "./listener.mjs";
import { hasAvatar, inPhase, openPage, startBrowser, startProgram } from "./program.mjs";

const seconds = Number(process.argv[2] ?? 30);
const program = await startProgram(["demo"]);
const browser = await startBrowser();
const { page, close } = await openPage(browser, program, {
  viewport: { width: 1280, height: 800 },
  deviceScaleFactor: 1,
});
await hasAvatar(page, "Plain");
await inPhase(page, "tracking");
const whole = await browser.newBrowserCDPSession();
/** Processor time of all processes of the browser, s. */
const browserTime = async () =>
  (await whole.send("SystemInfo.getProcessInfo")).processInfo.reduce((sum, p) => sum + p.cpuTime, 0);
const drawnSoFar = () => page.evaluate(() => window.telemime.counters.drawnSent);
const [drawnBefore, timeBefore, begin] = [await drawnSoFar(), await browserTime(), performance.now()];
await page.waitForTimeout(seconds * 1000);
const [drawnAfter, timeAfter, end] = [await drawnSoFar(), await browserTime(), performance.now()];
const drawn = (1000 * (drawnAfter - drawnBefore)) / (end - begin);
const cores = (1000 * (timeAfter - timeBefore)) / (end - begin);
const listener = await Listener.open(program); // not before: it costs time, too
const status = await listener.next((m) => m.type === "status");
listener.close();
await close();
await browser.close();
await program.stop();

const { ms, latency, fps, cpu, dropped } = status;
const load = readFileSync("/proc/loadavg", "utf8").split(" ")[0];
console.log(`frames: camera ${fps.input}, tracked ${fps.tracked}, drawn ${drawn.toFixed(1)} a second; ${dropped} dropped
From camera to pose: ${ms.total} ms, of which wait ${ms.wait}, features ${ms.features}, queue ${ms.queue}, search ${ms.search}
From camera to drawn avatar: median ${latency.median}, 95 % ${latency.p95} ms
Processor load: ${cpu} cores of the program, ${cores.toFixed(2)} of the browser; load of the machine ${load}`);
