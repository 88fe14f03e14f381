// SPDX-License-Identifier: Apache-2.0
// Files that are dropped on the page: avatars and others.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { test } from "node:test";
import { badAvatars, boxes, strangersVrm0 } from "./avatars.mjs";
import { boneErrors } from "./bones.mjs";
import { LONG, drop, hasAvatar, openPage, setUp } from "./program.mjs";

let program, listener, browser, page, complaints;
setUp(
  async (t) => {
    ({ program, listener, browser, page, complaints } = t);
    await hasAvatar(page, "Plain");
  },
  { page: true },
);

test("other files are refused with a reason", LONG, async () => {
  for (const [file, words] of badAvatars(program.folder)) {
    await drop(page, file);
    const toast = page.locator(".toast.error").last();
    await toast.filter({ hasText: words }).filter({ hasText: "The avatar stays as it was." }).waitFor();
    console.log(`${basename(file)}: ${await toast.innerText()}`);
    await toast.getByRole("button", { name: "Close this message" }).click();
    await page.locator(".toast").waitFor({ state: "detached" });
    assert.equal(await page.evaluate(() => window.telemime.avatar.name), "Plain");
  }
  const before = await page.evaluate(() => window.telemime.counters.renders);
  await page.waitForFunction((n) => window.telemime.counters.renders > n + 5, before);
  assert.deepEqual(complaints, []);
});

for (const [name, version, make] of [
  ["boxes", "1", (folder) => boxes(folder)],
  ["stranger", "0", (folder) => strangersVrm0(program, folder)],
]) {
  test(`VRM ${version}, rest rotations: ${name}`, LONG, async () => {
    await drop(page, await make(program.folder));
    await hasAvatar(page, name);
    assert.equal(await page.evaluate(() => window.telemime.avatar.version), version);
    const error = await boneErrors(page, listener.poses, 20);
    console.log(`${name}: bones ${error.mean.toFixed(3)} degrees off, at most ${error.worst.toFixed(3)}`);
    assert.ok(error.mean < 2);
    const side = (bone) => page.evaluate((b) => window.telemime.boneRotations()[b].position[0], bone);
    assert.ok((await side("leftUpperArm")) > (await side("rightUpperArm")) + 0.1, "it faces the camera");
    await page.reload();
    await hasAvatar(page, name); // the browser has stored it
    assert.deepEqual(complaints, []);
  });
}

test("a dropped file replaces a loading one", LONG, async () => {
  const other = await openPage(browser, program);
  await hasAvatar(other.page, "Plain");
  await other.page.evaluate(() =>
    localStorage.setItem("telemime", JSON.stringify({ avatar: "look:casual" })),
  );
  let goOn;
  const late = new Promise((resolve) => (goOn = resolve));
  const casual = /\/avatars\/casual.*\.vrm$/;
  await other.page.route(casual, async (route) => {
    await late;
    await route.continue();
  });
  const asked = other.page.waitForRequest(casual);
  await other.page.reload();
  await asked;
  const none = join(program.folder, "none.vrm");
  writeFileSync(none, "this is no avatar at all");
  const again = other.page.waitForRequest(casual);
  await drop(other.page, none);
  const toast = other.page.locator(".toast.error").filter({ hasText: "not a VRM avatar" });
  await toast.waitFor();
  assert.doesNotMatch(await toast.innerText(), /is shown|stays/); // casual may still arrive
  await again;
  await drop(other.page, boxes(program.folder));
  await hasAvatar(other.page, "boxes");
  const came = other.page.waitForResponse(casual);
  goOn();
  await (await came).finished();
  const before = await other.page.evaluate(() => window.telemime.counters.renders);
  await other.page.waitForFunction((n) => window.telemime.counters.renders > n + 10, before);
  assert.equal(await other.page.evaluate(() => window.telemime.avatar.name), "boxes");
  await other.page.reload();
  await hasAvatar(other.page, "boxes");
  assert.deepEqual(other.complaints, []);
  await other.close();
});
