// SPDX-License-Identifier: Apache-2.0
// Use of the page while the program tracks.

import assert from "node:assert/strict";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import { afterEach, test } from "node:test";
import { createServer } from "vite";
import { WebSocket } from "ws";
import { boneErrors } from "./bones.mjs";
import { LONG, hasAvatar, inPhase, setUp, tabTo } from "./program.mjs";

let listener, page, complaints, program;
setUp(
  async (t) => {
    ({ listener, page, complaints, program } = t);
    await hasAvatar(page, "Plain");
    await inPhase(page, "tracking");
  },
  { page: true },
);
afterEach(() => assert.deepEqual(complaints.splice(0), []));

const pressed = (id) => page.locator(id).getAttribute("aria-pressed");

test("the avatar is mirrored, and back", LONG, async () => {
  assert.equal(await pressed("#mirror-avatar"), "false");
  await page.keyboard.press("m");
  assert.equal(await pressed("#mirror-avatar"), "true");
  const mirrored = await boneErrors(page, listener.poses, 15, { mirror: true });
  await page.keyboard.press("m");
  const same = await boneErrors(page, listener.poses, 15);
  console.log(
    `bones: ${mirrored.mean.toFixed(4)} degrees off in the mirror, ${same.mean.toFixed(4)} without`,
  );
  assert.ok(mirrored.mean < 2 && same.mean < 2);
});

test("recalibrates by keyboard", LONG, async () => {
  const measured = listener.next((m) => m.type === "body");
  await page.keyboard.press("c");
  await measured;
  await listener.next((m) => m.type === "pose" && m.state === "tracking");
  await inPhase(page, "tracking");
});

test("a reloaded page keeps the choices", LONG, async () => {
  for (const key of ["m", "Shift+M", "o", "z"]) await page.keyboard.press(key);
  await page.keyboard.press("1");
  assert.equal(await page.evaluate(() => document.activeElement.id), "tab-avatar");
  await tabTo(page, "#avatars input:checked");
  await page.keyboard.press("ArrowDown");
  await hasAvatar(page, "Casual");
  await page.keyboard.press("3");
  const looks = () =>
    page.evaluate(() => ({
      avatar: window.telemime.avatar.name,
      tab: document.querySelector('[role="tab"][aria-selected="true"]').id,
      pressed: [...document.querySelectorAll("[aria-pressed]")].map((b) => [
        b.id,
        b.getAttribute("aria-pressed"),
      ]),
    }));
  const before = await looks();
  assert.equal(before.tab, "tab-recordings");
  assert.deepEqual(Object.fromEntries(before.pressed), {
    "mirror-avatar": "true",
    "mirror-picture": "false",
    overlay: "false",
    "close-up": "true",
  });
  await page.reload();
  await hasAvatar(page, "Casual");
  assert.deepEqual(await looks(), before);
  await inPhase(page, "tracking");
  assert.ok((await boneErrors(page, listener.poses, 5, { mirror: true })).mean < 2);
});

test("keys open and close a narrow panel", LONG, async () => {
  const wide = page.viewportSize();
  await page.setViewportSize({ width: 900, height: 640 });
  await page.locator("#panel").waitFor({ state: "hidden" });
  const active = () => page.evaluate(() => document.activeElement.id);
  await page.keyboard.press("2");
  assert.equal(await active(), "tab-send");
  await page.keyboard.press("Escape");
  await page.locator("#panel").waitFor({ state: "hidden" });
  await page.setViewportSize(wide);
});

test("single-key shortcuts can be turned off", LONG, async () => {
  const help = page.locator("#help-dialog");
  const overlay = await pressed("#overlay");
  const switchAndClose = async () => {
    await page.locator("#help-keys").focus();
    await page.keyboard.press("Space");
    await page.keyboard.press("Escape");
    await help.waitFor({ state: "hidden" });
    await page.keyboard.press("o");
  };
  await page.keyboard.press("?");
  await help.waitFor();
  await page.keyboard.press("o"); // keys go to the dialog
  assert.equal(await pressed("#overlay"), overlay);
  await switchAndClose();
  assert.equal(await pressed("#overlay"), overlay);
  await page.locator("#help").focus();
  await page.keyboard.press("Enter");
  await switchAndClose();
  assert.notEqual(await pressed("#overlay"), overlay);
});

test("high contrast shows what is chosen", LONG, async () => {
  await page.emulateMedia({ forcedColors: "active" });
  const style = (selector, name) =>
    page
      .locator(selector)
      .first()
      .evaluate((e, n) => getComputedStyle(e).getPropertyValue(n), name);
  const back = await style(".bar", "background-color");
  assert.equal(await style('.icon-button[aria-pressed="true"]', "border-top-width"), "2px");
  assert.equal(await style('.icon-button[aria-pressed="false"]', "border-top-width"), "0px");
  assert.notEqual(await style('[role="tab"][aria-selected="true"]', "border-bottom-color"), back);
  assert.equal(await style('[role="tab"][aria-selected="false"]', "border-bottom-color"), back);
  for (const mark of ["#state-dot", ".record-dot", ".legend .left", ".stage-bar span", ".stage-key i"])
    assert.notEqual(await style(mark, "background-color"), back, mark);
  await page.emulateMedia({ forcedColors: null });
});

test("records, saves and deletes by keyboard", LONG, async () => {
  await page.keyboard.press("r");
  await listener.next((m) => m.type === "status" && m.recording?.frames >= 40);
  await page.keyboard.press("r");
  await page.keyboard.press("3");
  const links = page.locator('a[href*="/recordings/"]');
  await links.first().waitFor();
  const names = [];
  for (const link of await links.all()) {
    const [download] = await Promise.all([page.waitForEvent("download"), link.click()]);
    const file = readFileSync(await download.path());
    assert.ok(file.length > 100, download.suggestedFilename());
    names.push(download.suggestedFilename());
  }
  for (const ending of ["bvh", "glb", "vrma", "csv", "trc", "jsonl", "bap"]) {
    assert.ok(
      names.some((n) => n.endsWith(`.${ending}`)),
      `${ending} among ${names}`,
    );
  }
  await page.getByRole("button", { name: "Delete recording 1" }).press("Enter");
  await page.getByRole("button", { name: "Press again to delete" }).press("Enter");
  await links.first().waitFor({ state: "detached" });
});

test("a recording is stopped before its status", LONG, async () => {
  await page.keyboard.press("r");
  await page.keyboard.press("r");
  await page.locator("#record-label").filter({ hasText: "Record" }).waitFor();
  let count = 0; // 2 s: a recording would have frames by now
  const late = await listener.next((m) => m.type === "status" && ++count >= 4);
  assert.equal(late.recording, null);
});

test("outputs are added, paused and removed", LONG, async () => {
  await page.keyboard.press("2");
  const box = page.locator("#output-url");
  await box.fill("vmc://localhost:39539");
  await box.press("Enter");
  await page.locator("#outputs").getByText("vmc://localhost:39539", { exact: true }).waitFor();
  await box.fill("pigeon://coop");
  await box.press("Enter");
  await page
    .getByText(/pigeon/)
    .first()
    .waitFor();
  const row = page.locator("#outputs").getByText("vmc://localhost:39539", { exact: true });
  const press = (what) => page.getByRole("button", { name: `${what} vmc://localhost:39539` }).press("Enter");
  const state = (is) =>
    listener.next(
      (m) => m.type === "status" && m.outputs.length === 1 && (m.outputs[0].state === "off") === is,
    );
  await press("Pause");
  await state(true);
  await press("Resume");
  await state(false);
  await press("Remove");
  await listener.next((m) => m.type === "status" && m.outputs.length === 0);
  await row.waitFor({ state: "detached" });
});

test("the server of `npm run dev` is let in", LONG, async () => {
  const target = `http://localhost:${program.port}`;
  const server = await createServer({
    configFile: "web/vite.config.ts",
    optimizeDeps: { noDiscovery: true }, // the pages are not opened
    server: { port: 0, proxy: { "/ws": { target }, "/avatars": { target } } },
  });
  await server.listen();
  const origin = `http://localhost:${server.httpServer.address().port}`;
  const socket = new WebSocket(`${origin.replace("http", "ws")}/ws`, { origin });
  const [hello] = await once(socket, "message");
  assert.equal(JSON.parse(hello).type, "hello");
  socket.terminate();
  assert.equal((await fetch(`${origin}/avatars/plain.vrm`)).status, 200);
  await server.close();
});
