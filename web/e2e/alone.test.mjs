// SPDX-License-Identifier: Apache-2.0
// The avatar alone (/avatar), beside an open live page: what OBS's browser source gets, pixels with their transparency.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";
import { boxes, ownAvatar } from "./avatars.mjs";
import { LIGHT, LONG, follows, hasAvatar, openPage, setUp, startProgram } from "./program.mjs";

const t = setUp(() => undefined, { flat: true, page: true });
const SIZE = { viewport: { width: 640, height: 480 }, deviceScaleFactor: 1 };

const open = async (query = "", program = t.program) =>
  openPage(t.browser, { url: `${program.url}avatar${query}` }, SIZE);

/** The page as OBS sees it: red, green, blue and alpha of a pixel, and how many pixels of a row are drawn. */
async function picture(page, folder = t.program.folder) {
  const file = join(folder, "picture.png");
  await page.screenshot({ path: file, omitBackground: true });
  const raw = ["-f", "rawvideo", "-pix_fmt", "rgba", "-"];
  const { stdout } = spawnSync("ffmpeg", ["-v", "error", "-i", file, ...raw], { maxBuffer: 1 << 28 });
  const width = 640;
  const height = stdout.length / 4 / width;
  const at = (x, y) => [...stdout.subarray(4 * (y * width + x), 4 * (y * width + x) + 4)];
  const row = (y) => Array.from({ length: width }, (_, x) => x).filter((x) => at(x, y)[3] > 128).length;
  const rows = Array.from({ length: height }, (_, y) => row(y));
  return { at, bottom: rows[height - 1], drawn: rows.reduce((a, b) => a + b), bytes: stdout };
}

const words = (page) => page.locator("#words");

test("a transparent ground and an avatar that moves", LONG, async () => {
  const { page, complaints, requested, close } = await open();
  await hasAvatar(page, "Plain");
  await follows(page);
  await page.waitForFunction(() => window.telemime.counters.rest === 0);
  const first = await picture(page);
  for (const [x, y] of [
    [0, 0],
    [639, 0],
    [0, 479],
    [639, 479],
  ])
    assert.deepEqual(first.at(x, y), [0, 0, 0, 0], `the corner at ${x}, ${y}`);
  assert.ok(first.drawn > 20000, `${first.drawn} pixels are drawn`);
  const before = await page.evaluate(() => window.telemime.boneRotations());
  await follows(page);
  const after = await page.evaluate(() => window.telemime.boneRotations());
  assert.notDeepEqual(after.leftUpperArm, before.leftUpperArm);
  assert.notDeepEqual((await picture(page)).bytes, first.bytes);
  await follows(t.page); // the live page goes on
  assert.equal(await page.evaluate(() => window.telemime.counters.misunderstood), 0);
  assert.ok(await words(page).isHidden());
  assert.deepEqual(complaints, []);
  assert.ok(requested.every((r) => r.startsWith(t.program.url)));
  await close();
});

test("the framings and the size", LONG, async () => {
  const seen = {};
  for (const framing of ["full", "bust", "head"]) {
    const { page, close } = await open(`?framing=${framing}&mirror=1`);
    await hasAvatar(page, "Plain");
    await page.waitForFunction(() => window.telemime.counters.renders > 3);
    seen[framing] = await picture(page);
    await close();
  }
  assert.equal(seen.full.bottom, 0, "the whole avatar has a margin below its feet");
  assert.ok(seen.bust.bottom > 20, "the picture cuts the upper body off");
  assert.ok(seen.head.bottom > 1.5 * seen.bust.bottom, `${seen.head.bottom} and ${seen.bust.bottom}`);
  assert.ok(seen.full.drawn < seen.bust.drawn && seen.bust.drawn < seen.head.drawn);
  const { page, close } = await open("?width=320&height=240");
  await hasAvatar(page, "Plain");
  assert.deepEqual(await page.locator("#avatar-canvas").boundingBox(), {
    x: 0,
    y: 0,
    width: 320,
    height: 240,
  });
  await close();
});

test("a ground in a colour", LONG, async () => {
  for (const [query, colour] of [
    ["?background=green", [0, 255, 0, 255]],
    ["?background=#20a060&framing=head", [32, 160, 96, 255]],
  ]) {
    const { page, close } = await open(query);
    await hasAvatar(page, "Plain");
    assert.deepEqual((await picture(page)).at(0, 0), colour);
    await close();
  }
});

test("mistakes in the address have words", LONG, async () => {
  for (const [query, text] of [
    ["?framing=feet", /"framing" cannot be "feet": it is one of bust, head, full/],
    ["?colour=red", /There is no option "colour". The options are avatar,/],
    ["?avatar=nobody", /no avatar "nobody". It has plain, /],
    ["?avatar=/avatars/nobody.vrm", /no avatar at .*nobody\.vrm \(status 404\)/],
    ["?avatar=/icon.svg", /not a VRM avatar/],
  ]) {
    const { page, close } = await open(query);
    await words(page).filter({ hasText: text }).waitFor();
    assert.equal(await page.evaluate(() => window.telemime.avatar), null);
    await close();
  }
});

test("a browser that cannot draw in 3-D has words", LONG, async () => {
  const { page, close } = await openPage(t.flat, { url: `${t.program.url}avatar` }, SIZE);
  await follows(page);
  await page.waitForLoadState("networkidle"); // the avatar has been loaded
  await words(page).filter({ hasText: "WebGL is off" }).waitFor();
  assert.equal(await page.evaluate(() => window.telemime.avatar), null);
  await close();
});

test("avatars of another server and of a folder of the user", LONG, async () => {
  const data = await ownAvatar(t.program, "robot-light");
  let allowed = true;
  const server = createServer((_, answer) => {
    if (allowed) answer.setHeader("Access-Control-Allow-Origin", "*");
    answer.end(data);
  });
  await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
  const address = encodeURIComponent(`http://127.0.0.1:${server.address().port}/me.vrm`);
  const stranger = await open(`?avatar=${address}`);
  await hasAvatar(stranger.page, "me.vrm");
  assert.deepEqual(stranger.complaints, []);
  await stranger.close();
  for (const debug of [false, true]) {
    allowed = false;
    const { page, complaints, close } = await open(`?avatar=${address}${debug ? "&debug" : ""}`);
    if (debug) await words(page).filter({ hasText: "cannot be reached or forbids it" }).waitFor();
    while (!complaints.some((c) => c.includes("CORS"))) await pause(100);
    await follows(page);
    assert.equal(await words(page).isVisible(), debug);
    allowed = true;
    await hasAvatar(page, "me.vrm"); // it is asked for again
    assert.ok(await words(page).isHidden());
    await close();
  }
  server.close();

  const folder = join(t.program.folder, "mine");
  mkdirSync(folder);
  copyFileSync(boxes(t.program.folder), join(folder, "boxes.vrm"));
  const own = await startProgram(["demo", ...LIGHT, "--avatars", folder]);
  const { page, close } = await open("?avatar=boxes", own);
  await hasAvatar(page, "Boxes");
  await close();
  assert.equal(await own.stop(), 0);
});

test("a program that stops leaves an avatar at rest, and finds it again", LONG, async () => {
  let program = await startProgram(["demo", ...LIGHT]);
  const silent = await open("", program);
  const debug = await open("?debug", program);
  for (const { page } of [silent, debug]) {
    await hasAvatar(page, "Plain");
    await follows(page);
  }
  const { port } = program;
  await program.stop();
  await words(debug.page).filter({ hasText: "No connection to Telemime" }).waitFor();
  await silent.page.waitForFunction(() => window.telemime.counters.rest === 1);
  await pause(500);
  assert.ok(await words(silent.page).isHidden(), "viewers see no words");
  const rest = await picture(silent.page);
  assert.ok(rest.drawn > 20000 && rest.at(0, 0)[3] === 0);
  program = await startProgram(["demo", ...LIGHT], { port });
  for (const { page } of [silent, debug]) await follows(page);
  assert.ok(await words(debug.page).isHidden());
  await silent.close();
  await debug.close();
  assert.equal(await program.stop(), 0);
});
