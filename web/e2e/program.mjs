// SPDX-License-Identifier: Apache-2.0
// The real program and a real Chromium, for the tests beside this file. TELEMIME_PROGRAM and TELEMIME_CHROMIUM name them.

import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before } from "node:test";
import { chromium } from "playwright-core";
import { launchOptions } from "./chromium.mjs";
import { Listener } from "./listener.mjs";
import { launch } from "./process.mjs";

const PROGRAM = process.env.TELEMIME_PROGRAM;

/** How long one step of a test may take on a busy computer, ms. */
export const PATIENCE = 120000;
export const LONG = { timeout: 6 * PATIENCE };

/** Options of the program for tests that do not judge the tracking: the processor is the browser's. */
export const LIGHT = ["--particles", "400", "--threads", "1"];

/** `telemime live ...` at any free port; its `folder` is removed by stop() or kill(). */
export async function startProgram(args, { port = 0 } = {}) {
  if (!PROGRAM) throw new Error("TELEMIME_PROGRAM does not name the program");
  const folder = mkdtempSync(join(tmpdir(), "telemime-page-"));
  const options = ["--port", String(port), "--recordings", join(folder, "recordings")];
  const program = await launch(PROGRAM, ["live", ...args, ...options], {
    env: { XDG_CONFIG_HOME: folder }, // no settings of a user
    ready: (output) => /localhost:(\d+)/.exec(output)?.[1],
  });
  const end = async (signal) => {
    const code = await program.end(signal);
    rmSync(folder, { recursive: true, force: true });
    return code;
  };
  return {
    pid: program.pid,
    port: Number(program.found),
    url: `http://localhost:${program.found}/`,
    folder,
    output: program.output,
    stop: () => end("SIGINT"),
    kill: () => end("SIGKILL"),
  };
}

/** Arguments of a browser that cannot draw in 3-D. */
export const FLAT = ["--disable-gpu", "--disable-3d-apis"];

export const startBrowser = (args) => chromium.launch(launchOptions(args));

/** The processes that draw pages of this browser. */
export async function renderers(browser) {
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  return processInfo.filter((p) => p.type === "renderer").map((p) => p.id);
}

/**
 * Opens a page of `program`, or of another `url`. `complaints` holds the errors of the console and the page (also of the
 * content security policy); `requested` all addresses that it requested. `script` runs before the page's own. It has half
 * the pixels: without a graphics card each costs processor time.
 */
export async function openPage(browser, { url }, { script = null, ...options } = {}) {
  const context = await browser.newContext({
    viewport: { width: 1220, height: 640 },
    deviceScaleFactor: 0.5,
    acceptDownloads: true,
    ...options,
  });
  context.setDefaultTimeout(PATIENCE);
  if (script) await context.addInitScript(script);
  const page = await context.newPage();
  const [complaints, requested] = [[], []];
  page.on("console", (m) => {
    if (m.type() === "error") complaints.push(m.text());
  });
  page.on("pageerror", (e) => complaints.push(String(e)));
  page.on("request", (r) => requested.push(r.url()));
  await page.goto(url);
  return { page, complaints, requested, close: () => context.close() };
}

/**
 * Before the tests of a file: a browser, the program, and a client that listens to it; with `flat` a browser without 3-D,
 * with `page` an open page. `ready` gets them all. After the tests they are closed.
 */
export function setUp(ready, { args = () => ["demo", ...LIGHT], flat = false, page = false } = {}) {
  const t = {};
  before(async () => {
    t.browser = await startBrowser();
    if (flat) t.flat = await startBrowser(FLAT);
    t.program = await startProgram(await args());
    t.listener = await Listener.open(t.program);
    if (page) Object.assign(t, await openPage(t.browser, t.program));
    await ready(t);
  });
  after(async () => {
    await t.close?.();
    await t.browser?.close();
    await t.flat?.close();
    t.listener?.close();
    assert.equal(await t.program?.stop(), 0, "the exit status of the program");
  });
  return t;
}

export const inPhase = (page, phase) => page.waitForFunction((p) => window.telemime?.phase === p, phase);

export const hasAvatar = (page, name) =>
  page.waitForFunction((n) => window.telemime?.avatar?.name === n, name);

/** Waits until the page has received poses that are newer than this call. */
export async function follows(page) {
  await inPhase(page, "tracking");
  const before = await page.evaluate(() => window.telemime.counters.poses);
  await page.waitForFunction((n) => window.telemime.counters.poses >= n + 5, before);
}

/** Presses Tab until the element has the focus. */
export async function tabTo(page, selector) {
  for (let i = 0; i < 60; i++) {
    await page.keyboard.press("Tab");
    if (await page.locator(selector).evaluate((e) => e === document.activeElement)) return;
  }
  throw new Error(`${selector} cannot be reached by keyboard`);
}

/** Drops files on the page as a file manager does: the browser itself reads them. */
export async function drop(page, ...files) {
  const session = await page.context().newCDPSession(page);
  const data = { items: [], files, dragOperationsMask: 1 };
  for (const type of ["dragEnter", "dragOver", "drop"]) {
    await session.send("Input.dispatchDragEvent", { type, x: 300, y: 300, data });
  }
  await session.detach();
}
