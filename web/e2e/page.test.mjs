// SPDX-License-Identifier: Apache-2.0
// What a person does with the page, with the real program and a real Chromium:
//   TELEMIME_PROGRAM=build/release/telemime npm run e2e

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { hasAvatar, inPhase, openPage, startBrowser, startProgram } from "./program.mjs";

let browser;
let program;
before(async () => {
  browser = await startBrowser();
  program = await startProgram(["demo"]);
});
after(async () => {
  await browser?.close();
  assert.equal(await program?.stop(), 0, "the program ends well");
});

const degrees = (a, b) => {
  const dot = Math.abs(a.reduce((sum, x, i) => sum + x * b[i], 0));
  return (2 * Math.acos(Math.min(1, dot)) * 180) / Math.PI;
};

const PARENT = { spine: "hips", chest: "spine", neck: "chest", head: "neck" };
for (const side of ["left", "right"]) {
  PARENT[`${side}Shoulder`] = "chest";
  PARENT[`${side}UpperArm`] = `${side}Shoulder`;
  PARENT[`${side}LowerArm`] = `${side}UpperArm`;
  PARENT[`${side}Hand`] = `${side}LowerArm`;
}

const product = ([ax, ay, az, aw], [bx, by, bz, bw]) => [
  aw * bx + ax * bw + ay * bz - az * by,
  aw * by - ax * bz + ay * bw + az * bx,
  aw * bz + ax * by - ay * bx + az * bw,
  aw * bw - ax * bx - ay * by - az * bz,
];

/** The turn of a bone in the world, by what was sent of it and of the bones that it hangs on. */
const turned = (bones, name) =>
  PARENT[name] ? product(turned(bones, PARENT[name]), bones[name]) : bones[name];

/**
 * Mean difference of the turns of the file's own bones in the world from those that were sent, over `count` frames;
 * degrees.
 */
async function boneErrors(page, poses, count) {
  const errors = [];
  const seen = new Set();
  while (seen.size < count) {
    const { frame, bones } = await page.evaluate(() => ({
      frame: window.telemime.counters.shown,
      bones: Object.fromEntries(
        Object.entries(window.telemime.boneRotations()).map(([name, b]) => [name, b.world]),
      ),
    }));
    const pose = poses.get(frame);
    if (pose?.state === "tracking" && !seen.has(frame)) {
      seen.add(frame);
      for (const name of Object.keys(pose.bones)) {
        errors.push(degrees(turned(pose.bones, name), bones[name]));
      }
    }
  }
  return errors.reduce((a, b) => a + b, 0) / errors.length;
}

async function loadFile(page, file) {
  await page.setInputFiles("#avatar-file", file);
}

test("the avatar's bones are those that were tracked: the default, VRM 1.0", async () => {
  const { page, poses, complaints, close } = await openPage(browser, program);
  await hasAvatar(page, "Plain");
  await inPhase(page, "tracking");
  const error = await boneErrors(page, poses, 40);
  console.log(`bones: ${error.toFixed(4)} degrees`);
  assert.ok(error < 2, `${error} degrees`);
  assert.deepEqual(complaints, []);
  await close();
});

test("the same of a VRM 0.x file that is dropped", async () => {
  const { page, poses, complaints, close } = await openPage(browser, program);
  await hasAvatar(page, "Plain");
  const one = join(program.folder, "one.vrm");
  const zero = join(program.folder, "zero.vrm");
  writeFileSync(one, Buffer.from(await (await fetch(`${program.url}avatars/plain.vrm`)).arrayBuffer()));
  execFileSync("node", [new URL("../mock/to-vrm0.mjs", import.meta.url).pathname, one, zero]);
  const bytes = readFileSync(zero).toString("base64");
  const transfer = await page.evaluateHandle((data) => {
    const files = new DataTransfer();
    const array = Uint8Array.from(atob(data), (c) => c.charCodeAt(0));
    files.items.add(new File([array], "zero.vrm"));
    return files;
  }, bytes);
  await page.dispatchEvent("body", "dragenter", { dataTransfer: transfer });
  await page.dispatchEvent("body", "dragover", { dataTransfer: transfer });
  await page.dispatchEvent("body", "drop", { dataTransfer: transfer });
  await page.waitForFunction(() => window.telemime.avatar?.version === "0", null, { timeout: 60000 });
  await inPhase(page, "tracking");
  const error = await boneErrors(page, poses, 40);
  console.log(`bones: ${error.toFixed(4)} degrees`);
  assert.ok(error < 2, `${error} degrees`);
  await page.reload();
  await page.waitForFunction(() => window.telemime?.avatar?.version === "0", null, { timeout: 60000 });
  assert.deepEqual(complaints, []);
  await close();
});

test("a file that is no avatar is told in words, and the old one stays", async () => {
  const { page, close } = await openPage(browser, program);
  await hasAvatar(page, "Plain");
  const junk = join(program.folder, "junk.vrm");
  writeFileSync(junk, "this is no avatar");
  await loadFile(page, junk);
  await page
    .locator(".toast, [role=alert], [role=status]")
    .filter({ hasText: /VRM|avatar|file/i })
    .first()
    .waitFor();
  assert.equal(await page.evaluate(() => window.telemime.avatar.name), "Plain");
  await close();
});

test("records by keyboard; every file can be saved", async () => {
  const { page, complaints, close } = await openPage(browser, program);
  await inPhase(page, "tracking");
  await page.keyboard.press("r");
  await page.waitForTimeout(2000); // of motion to be recorded
  await page.keyboard.press("r");
  await page.getByRole("tab", { name: "Recordings" }).click();
  const links = page.locator('a[href*="/recordings/"]');
  await links.first().waitFor();
  const names = [];
  for (const link of await links.all()) {
    const [download] = await Promise.all([page.waitForEvent("download"), link.click()]);
    const file = readFileSync(await download.path());
    assert.ok(file.length > 100, download.suggestedFilename());
    names.push(download.suggestedFilename());
  }
  for (const ending of ["bvh", "glb", "vrma", "csv", "trc", "jsonl"]) {
    assert.ok(
      names.some((n) => n.endsWith(`.${ending}`)),
      `${ending} among ${names}`,
    );
  }
  assert.deepEqual(complaints, []);
  await close();
});

test("outputs come and go, wrong ones are refused in words", async () => {
  const { page, close } = await openPage(browser, program);
  await page.getByRole("tab", { name: "Send" }).click();
  const box = page.locator("#output-url");
  await box.fill("vmc://localhost:39539");
  await box.press("Enter");
  await page.getByText("vmc://localhost:39539", { exact: true }).first().waitFor();
  await box.fill("pigeon://coop");
  await box.press("Enter");
  await page
    .getByText(/pigeon/)
    .first()
    .waitFor();
  await close();
});

test("ten pages at once", async () => {
  const pages = await Promise.all(
    Array.from({ length: 10 }, () => openPage(browser, program, { viewport: { width: 400, height: 300 } })),
  );
  for (const { page, poses } of pages) {
    await inPhase(page, "tracking");
    assert.ok(poses.size > 0);
  }
  await Promise.all(pages.map((p) => p.close()));
});
