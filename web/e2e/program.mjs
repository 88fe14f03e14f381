// SPDX-License-Identifier: Apache-2.0
// The real program and a real Chromium, for the tests beside this file.

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const PROGRAM = process.env.TELEMIME_PROGRAM;
const CHROMIUM = process.env.TELEMIME_CHROMIUM ?? "/usr/bin/chromium";

/** `telemime live ...` at any free port; `folder` is its own and goes away with stop(). */
export async function startProgram(args) {
  if (!PROGRAM) throw new Error("TELEMIME_PROGRAM does not say where the program is");
  const folder = mkdtempSync(join(tmpdir(), "telemime-page-"));
  const child = spawn(PROGRAM, ["live", ...args, "--port", "0", "--recordings", join(folder, "recordings")], {
    stdio: ["ignore", "pipe", "pipe"],
  });
  const heard = { out: "", err: "" };
  child.stdout.on("data", (d) => (heard.out += d));
  child.stderr.on("data", (d) => (heard.err += d));
  const ended = new Promise((resolve) => child.on("exit", resolve));
  const port = await new Promise((resolve, reject) => {
    child.stdout.on("data", () => {
      const found = /localhost:(\d+)/.exec(heard.out);
      if (found) resolve(Number(found[1]));
    });
    void ended.then((code) => reject(new Error(`the program ended (${code}): ${heard.err}`)));
  });
  return {
    port,
    url: `http://localhost:${port}/`,
    folder,
    heard,
    async stop() {
      child.kill("SIGINT");
      const code = await ended;
      rmSync(folder, { recursive: true, force: true });
      return code;
    },
  };
}

export function startBrowser() {
  return chromium.launch({
    executablePath: CHROMIUM,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}

/**
 * The page, opened: `poses` holds the pose messages by frame, `complaints` what the console and the page said
 * against themselves (a broken content security policy, too).
 */
export async function openPage(browser, program, options = {}) {
  const context = await browser.newContext({
    viewport: { width: 1280, height: 800 },
    acceptDownloads: true,
    ...options,
  });
  const page = await context.newPage();
  const poses = new Map();
  const complaints = [];
  page.on("console", (m) => {
    if (m.type() === "error") complaints.push(m.text());
  });
  page.on("pageerror", (e) => complaints.push(String(e)));
  page.on("websocket", (socket) =>
    socket.on("framereceived", ({ payload }) => {
      if (typeof payload !== "string") return;
      const message = JSON.parse(payload);
      if (message.type === "pose") poses.set(message.frame, message);
    }),
  );
  await page.goto(program.url);
  return { page, poses, complaints, close: () => context.close() };
}

export const inPhase = (page, phase) =>
  page.waitForFunction((p) => window.telemime?.phase === p, phase, { timeout: 60000 });

export const hasAvatar = (page, name) =>
  page.waitForFunction((n) => window.telemime?.avatar?.name === n, name, { timeout: 60000 });
