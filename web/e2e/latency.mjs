// SPDX-License-Identifier: Apache-2.0
// From the camera to the avatar drawn, with the bundled clip as the camera and a real Chromium:
//   TELEMIME_PROGRAM=build/release/telemime node e2e/latency.mjs [seconds]

import { readFileSync } from "node:fs";
import { hasAvatar, inPhase, openPage, startBrowser, startProgram } from "./program.mjs";

const seconds = Number(process.argv[2] ?? 30);
const program = await startProgram(["demo"]);
const browser = await startBrowser();
const { page, close } = await openPage(browser, program, {
  viewport: { width: 1280, height: 800 },
  deviceScaleFactor: 1,
});
let status = null;
await hasAvatar(page, "Plain");
await inPhase(page, "tracking");
const session = await page.context().newCDPSession(page);
await session.send("Network.enable");
session.on("Network.webSocketFrameReceived", ({ response }) => {
  if (response.opcode === 1 && response.payloadData.includes('"type":"status"')) {
    status = JSON.parse(response.payloadData);
  }
});
const drawnBefore = await page.evaluate(() => window.telemime.counters.drawnSent);
await page.waitForTimeout(seconds * 1000);
const drawn = (await page.evaluate(() => window.telemime.counters.drawnSent)) - drawnBefore;
await close();
await browser.close();
await program.stop();

const { ms, latency, fps, cpu, dropped } = status;
const load = readFileSync("/proc/loadavg", "utf8").split(" ")[0];
console.log(`frames: camera ${fps.input}, tracked ${fps.tracked}, drawn ${(drawn / seconds).toFixed(1)} a second; ${dropped} dropped
ms: wait ${ms.wait}, features ${ms.features}, queue ${ms.queue}, search ${ms.search}; camera to pose ${ms.total}
camera to avatar drawn: median ${latency.median}, 95 % ${latency.p95} ms
processor: ${cpu} cores of the program; load of the machine ${load}`);
