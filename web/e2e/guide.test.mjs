// SPDX-License-Identifier: Apache-2.0
// The guided setup by keyboard alone, with a network camera.

import assert from "node:assert/strict";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { picturesOf, startCamera } from "./camera.mjs";
import { LIGHT, LONG, inPhase, setUp, tabTo } from "./program.mjs";

const DEMO = process.env.TELEMIME_DEMO ?? fileURLToPath(new URL("../../data/demo", import.meta.url));
const room = picturesOf(`${DEMO}/background.mp4`);
const person = picturesOf(`${DEMO}/video.mp4`);

let camera, page, listener, program, complaints;
setUp(
  async (t) => {
    ({ page, listener, program, complaints } = t);
    await page.evaluate(() => {
      window.steps = [];
      const guide = document.getElementById("guide");
      const note = () => guide.hidden || window.steps.push(guide.dataset.step);
      new MutationObserver(note).observe(guide, { attributes: true, attributeFilter: ["data-step"] });
    });
  },
  { args: async () => [(camera = await startCamera(room, 15)).url, "--guide", ...LIGHT], page: true },
);
after(() => camera?.close());

const title = (words) => page.locator("#guide-title").filter({ hasText: words }).waitFor();
const focused = () => page.evaluate(() => document.activeElement.id);
const steps = () => page.evaluate(() => window.steps.splice(0));
const following = async () => {
  await inPhase(page, "tracking");
  await page.locator("#guide").waitFor({ state: "hidden" });
  assert.equal(await page.locator("#main").getAttribute("data-layout"), "live");
  await page.waitForFunction(() => window.telemime.counters.rest === 0 && window.telemime.counters.shown > 0);
};

test("the countdown, then the person steps in", LONG, async () => {
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
  assert.match(program.output.err, /background: the empty room/);
});

test("again, without the countdown", LONG, async () => {
  await page.keyboard.press("g");
  await title("Step out of view");
  camera.show(room);
  await listener.next((m) => m.type === "status"); // the program has frames of the room by then
  await listener.next((m) => m.type === "status");
  await tabTo(page, "#guide-now");
  await page.keyboard.press("Enter");
  await title("Step in and face the camera");
  assert.equal(await focused(), "guide-title"); // the pressed button is gone
  await tabTo(page, "#guide-back");
  camera.show(person);
  await following();
  assert.equal(await focused(), "main");
});

test("again, skipped with the person in view", LONG, async () => {
  await page.keyboard.press("g");
  await title("Step out of view");
  await tabTo(page, "#guide-skip");
  await steps();
  await page.keyboard.press("Enter");
  await following();
  const seen = await steps();
  assert.ok(seen.includes("Capturing the background around you"), seen.join());
  assert.ok(!seen.includes("Capturing the background"), "nobody has to stay out of view");
  assert.deepEqual(complaints, []);
});
