// SPDX-License-Identifier: Apache-2.0
// Ten pages at once, eight of them in a browser that cannot draw in 3-D, which costs less.

import assert from "node:assert/strict";
import { test } from "node:test";
import { LONG, follows, hasAvatar, openPage, setUp } from "./program.mjs";

const t = setUp(() => undefined, { flat: true });

test("ten pages", LONG, async () => {
  const pages = [];
  const small = { viewport: { width: 480, height: 320 } };
  for (let i = 0; i < 10; i++) pages.push(await openPage(i < 2 ? t.browser : t.flat, t.program, small));
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
  await t.listener.tracked(5);
});
