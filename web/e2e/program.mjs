// SPDX-License-Identifier: Apache-2.0
// The real program and a real Chromium, for the tests beside this file. TELEMIME_PROGRAM says where the former is,
// TELEMIME_CHROMIUM where the latter is.

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const PROGRAM = process.env.TELEMIME_PROGRAM;
const CHROMIUM = process.env.TELEMIME_CHROMIUM ?? "/usr/bin/chromium";

/** What a test on a busy computer may take at most, ms; nothing waits for so long when all is well. */
export const PATIENCE = 120000;

/** Options of the program for tests that do not judge the tracking: the processor is the browser's. */
export const LIGHT = ["--particles", "400", "--threads", "1"];

/** `telemime live ...`, at any free port; `folder` is its own and goes away with stop() or kill(). */
export async function startProgram(args, { port = 0 } = {}) {
  if (!PROGRAM) throw new Error("TELEMIME_PROGRAM does not say where the program is");
  const folder = mkdtempSync(join(tmpdir(), "telemime-page-"));
  const child = spawn(
    PROGRAM,
    ["live", ...args, "--port", String(port), "--recordings", join(folder, "recordings")],
    {
      stdio: ["ignore", "pipe", "pipe"],
      env: { ...process.env, XDG_CONFIG_HOME: folder }, // nobody's own settings
    },
  );
  const heard = { out: "", err: "" };
  child.stdout.on("data", (d) => (heard.out += d));
  child.stderr.on("data", (d) => (heard.err += d));
  const ended = new Promise((resolve) => child.on("exit", resolve));
  const opened = await new Promise((resolve, reject) => {
    child.stdout.on("data", () => {
      const found = /localhost:(\d+)/.exec(heard.out);
      if (found) resolve(Number(found[1]));
    });
    void ended.then((code) => reject(new Error(`the program ended (${code}): ${heard.err}`)));
  });
  const end = async (signal) => {
    child.kill(signal);
    const code = await ended;
    rmSync(folder, { recursive: true, force: true });
    return code;
  };
  return {
    pid: child.pid,
    port: opened,
    url: `http://localhost:${opened}/`,
    folder,
    heard,
    stop: () => end("SIGINT"),
    kill: () => end("SIGKILL"),
  };
}

/** Of a browser that cannot draw in 3-D. */
export const FLAT = ["--disable-gpu", "--disable-3d-apis"];

// As on a computer without a graphics card: WebGL in software, the page itself drawn without it.
export function startBrowser(args = ["--enable-unsafe-swiftshader"]) {
  return chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox", ...args] });
}

/**
 * The page, opened. `complaints` holds what the console and the page said against themselves (a broken content
 * security policy, too). Half the pixels: without a graphics card each costs processor time.
 */
export async function openPage(browser, program, options = {}) {
  const context = await browser.newContext({
    viewport: { width: 1220, height: 640 },
    deviceScaleFactor: 0.5,
    acceptDownloads: true,
    ...options,
  });
  context.setDefaultTimeout(PATIENCE);
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (m) => {
    if (m.type() === "error") complaints.push(m.text());
  });
  page.on("pageerror", (e) => complaints.push(String(e)));
  await page.goto(program.url);
  return { page, complaints, close: () => context.close() };
}

export const inPhase = (page, phase) => page.waitForFunction((p) => window.telemime?.phase === p, phase);

export const hasAvatar = (page, name) =>
  page.waitForFunction((n) => window.telemime?.avatar?.name === n, name);

/** Waits until the page has what came after this call. */
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

/** Lets go of files as a file manager does over the page: the browser itself reads them. */
export async function drop(page, ...files) {
  const session = await page.context().newCDPSession(page);
  const data = { items: [], files, dragOperationsMask: 1 };
  for (const type of ["dragEnter", "dragOver", "drop"]) {
    await session.send("Input.dispatchDragEvent", { type, x: 300, y: 300, data });
  }
  await session.detach();
}
