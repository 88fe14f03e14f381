// SPDX-License-Identifier: Apache-2.0
// Ten pages at once, eight of them in a browser that cannot draw in 3-D: that costs less, and the page has a word for it.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Listener } from "./listener.mjs";
import {
  FLAT,
  LIGHT,
  PATIENCE,
  follows,
  hasAvatar,
  openPage,
  startBrowser,
  startProgram,
} from "./program.mjs";

let program, browser, flat, listener;
before(async () => {
  browser = await startBrowser();
  flat = await startBrowser(FLAT);
  program = await startProgram(["demo", ...LIGHT]);
  listener = await Listener.open(program);
});
after(async () => {
  await browser?.close();
  await flat?.close();
  listener?.close();
  assert.equal(await program?.stop(), 0, "the program ends well");
});

test("ten pages", { timeout: 3 * PATIENCE }, async () => {
  const pages = [];
  const small = { viewport: { width: 480, height: 320 } };
  for (let i = 0; i < 10; i++) pages.push(await openPage(i < 2 ? browser : flat, program, small));
  for (const { page } of pages) await follows(page);
  const last = pages[9].page;
  await last.locator(".toast").filter({ hasText: "WebGL is off" }).waitFor();
  await last.waitForFunction(() => window.telemime.counters.decoded > 5);
  for (const { page, complaints } of pages.slice(0, 2)) {
    await hasAvatar(page, "Plain");
    await page.waitForFunction(() => window.telemime.counters.shown > 0);
    assert.deepEqual(complaints, []);
  }
  for (const p of pages) await p.close();
  await listener.tracked(5);
});
