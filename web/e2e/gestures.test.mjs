// SPDX-License-Identifier: Apache-2.0
// The avatar shows the tracked motion: four gestures on a VRM 1.0 and a VRM 0.x avatar, read from one page that stays open
// while the program is restarted.

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { strangersVrm0 } from "./avatars.mjs";
import { boneErrors } from "./bones.mjs";
import { Listener } from "./listener.mjs";
import { LIGHT, LONG, drop, hasAvatar, inPhase, openPage, startBrowser, startProgram } from "./program.mjs";

const FRAMES = 15; // of each gesture and avatar
const CLIPS =
  process.env.TELEMIME_CLIPS ?? fileURLToPath(new URL("../../../shared/data/dev", import.meta.url));
const GESTURES = ["raising_arms", "joy", "exclaiming", "asking"];

function inputs() {
  const clip = (gesture, name) => join(CLIPS, gesture, `${name}.mp4`);
  if (GESTURES.every((g) => existsSync(clip(g, "video")))) {
    return GESTURES.map((g) => [g, [clip(g, "video"), "--background", clip(g, "background"), "--loop"]]);
  }
  for (const g of GESTURES)
    test(g, { skip: `its clip is not at ${CLIPS} (TELEMIME_CLIPS)` }, () => undefined);
  return [["asking, the bundled clip", ["demo"]]];
}

let browser, program, page, close;
before(async () => {
  browser = await startBrowser();
});
after(async () => {
  await close?.();
  await browser?.close();
  await program?.stop();
});

const choose = async (name) => {
  if ((await page.evaluate(() => window.telemime.avatar.name)) === name) return;
  await page.getByRole("radio", { name }).check();
  await hasAvatar(page, name);
};

const order = ["Plain", "stranger"];
for (const [gesture, args] of inputs()) {
  test(gesture, LONG, async () => {
    program = await startProgram([...args, ...LIGHT], { port: program?.port });
    const listener = await Listener.open(program);
    if (!page) {
      ({ page, close } = await openPage(browser, program));
      await hasAvatar(page, "Plain");
      await drop(page, await strangersVrm0(program, program.folder));
      await hasAvatar(page, "stranger");
      order.reverse();
    }
    await inPhase(page, "tracking");
    for (const avatar of order) {
      await choose(avatar);
      const { version } = await page.evaluate(() => window.telemime.avatar);
      const error = await boneErrors(page, listener.poses, FRAMES);
      console.log(
        `${gesture}, VRM ${version}: bones ${error.mean.toFixed(4)} degrees off, at most ${error.worst.toFixed(4)}; fingers ${error.fingers.mean.toFixed(4)}, at most ${error.fingers.worst.toFixed(4)}`,
      );
      assert.ok(error.mean <= 2);
      if (listener.status.ms.networks > 0) assert.ok(error.fingers.mean <= 2, "fingers");
      else console.log("fingers are not checked: without networks no hands are tracked");
    }
    order.reverse(); // the next begins with the one that is shown
    listener.close();
    assert.equal(await program.stop(), 0, "the exit status of the program");
    await page.locator("#banner").filter({ hasText: "No connection to Telemime" }).waitFor();
  });
}
