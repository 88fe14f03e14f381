// SPDX-License-Identifier: Apache-2.0
// The guided start, by keyboard alone: the real program with a network camera, and a real Chromium.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { picturesOf, startCamera } from "./camera.mjs";
import { Listener } from "./listener.mjs";
import { LIGHT, PATIENCE, inPhase, openPage, startBrowser, startProgram, tabTo } from "./program.mjs";

const DEMO = process.env.TELEMIME_DEMO ?? fileURLToPath(new URL("../../data/demo", import.meta.url));
const room = picturesOf(`${DEMO}/background.mp4`);
const person = picturesOf(`${DEMO}/video.mp4`);

let camera, program, listener, browser, page, close, complaints;
before(async () => {
  browser = await startBrowser();
  camera = await startCamera(room, 15);
  program = await startProgram([camera.url, ...LIGHT]);
  listener = await Listener.open(program); // from here on somebody is there to be guided
  ({ page, close, complaints } = await openPage(browser, program));
  await page.evaluate(() => {
    window.steps = [];
    const guide = document.getElementById("guide");
    const note = () => guide.hidden || window.steps.push(guide.dataset.step);
    new MutationObserver(note).observe(guide, { attributes: true, attributeFilter: ["data-step"] });
  });
});
after(async () => {
  await close?.();
  await browser?.close();
  listener?.close();
  const code = await program?.stop();
  camera?.close();
  assert.equal(code, 0, "the program ends well");
});

const title = (words) => page.locator("#guide-title").filter({ hasText: words }).waitFor();
const steps = () => page.evaluate(() => window.steps.splice(0));
const following = async () => {
  await inPhase(page, "tracking");
  await page.locator("#guide").waitFor({ state: "hidden" });
  assert.equal(await page.locator("#main").getAttribute("data-layout"), "live");
  await page.waitForFunction(() => window.telemime.counters.rest === 0 && window.telemime.counters.shown > 0);
};

test("steps out, counts down, steps in, is followed", { timeout: 2 * PATIENCE }, async () => {
  await title("Step out of view");
  assert.equal(await page.locator("#main").getAttribute("data-layout"), "guide");
  await tabTo(page, "#guide-count");
  await page.keyboard.press("Enter");
  await page.locator("#countdown").filter({ hasText: "5" }).waitFor();
  await page.keyboard.press("Space"); // the same button stops it
  await page.locator("#countdown").waitFor({ state: "hidden" });
  assert.equal(await page.evaluate(() => window.telemime.phase), "empty_room");
  await steps();
  await page.keyboard.press("e");
  await title("Step in and face the camera");
  camera.show(person);
  await following();
  assert.deepEqual(await steps(), ["Capturing the background", "Step in and face the camera", "Done"]);
  assert.match(program.heard.err, /background: the empty room/);
});

test("again, without the countdown", { timeout: 2 * PATIENCE }, async () => {
  await page.keyboard.press("g");
  await title("Step out of view");
  camera.show(room);
  await listener.heard((m) => m.type === "status"); // the program has had pictures of the room since
  await listener.heard((m) => m.type === "status");
  await tabTo(page, "#guide-now");
  await page.keyboard.press("Enter");
  await title("Step in and face the camera");
  camera.show(person);
  await following();
});

test("again, and skipped with the person in the picture", { timeout: 2 * PATIENCE }, async () => {
  await page.keyboard.press("g");
  await title("Step out of view");
  await tabTo(page, "#guide-skip");
  await steps();
  await page.keyboard.press("Enter");
  await following();
  const seen = await steps();
  assert.ok(seen.includes("Capturing the background around you"), seen.join());
  assert.ok(!seen.includes("Capturing the background"), "nobody was to stay out of the picture");
  assert.deepEqual(complaints, []);
});
