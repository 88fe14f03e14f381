// SPDX-License-Identifier: Apache-2.0
// Runs the peer, MediaPipe Pose (full), on a video file in headless Chromium without network:
//   node track.mjs VIDEO OUT.json --packages node_modules [--frames N]
// Every frame is processed, at the time that the file states, with the default settings: smoothing on, complexity 1. The
// networks run on the processor, which without a graphics card is much faster than WebGL.
// OUT.json: tool, browser, width, height and frames: {frame, time (s), ms, image, world}, where image has 33 times [x / width, y / height, z,
// visibility] and world 33 times [x, y, z (m, from the middle of the hips), visibility], or null if nobody was found.

import { readFileSync, realpathSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { basename, extname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { parseArgs } from "node:util";
import { SOFTWARE_WEBGL, launchOptions } from "../../../web/e2e/chromium.mjs";
import { frameTimes, framesOf } from "./clip_frames.mjs";

const HERE = fileURLToPath(new URL(".", import.meta.url));
const PAGE = '<canvas></canvas><script src="/package/pose.js"></script><script src="/page.js"></script>';
const TYPES = { ".js": "text/javascript", ".wasm": "application/wasm" };
// No name of a host is resolved, and the browser itself asks for nothing.
const NO_NETWORK = [
  "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
  "--no-proxy-server",
  "--disable-background-networking",
  "--disable-component-update",
];

/** Serves the page, the files of the package and, by /frame, one frame after the other. */
async function serve(video, packageFolder, most) {
  const times = frameTimes(video);
  const frames = framesOf(video);
  let served = 0;
  const nextFrame = async (response) => {
    const { done, value } = served < most ? await frames.next() : { done: true };
    if (done) return response.writeHead(204).end();
    const time = times[served++];
    if (time === undefined) throw new Error(`${video} has more frames than time stamps`);
    const { width, height, rgba } = value;
    return response.writeHead(200, { "x-width": width, "x-height": height, "x-time": time }).end(rgba);
  };
  const server = createServer(async (request, response) => {
    const name = basename(request.url);
    try {
      if (request.url === "/frame") return await nextFrame(response);
      if (request.url === "/page.js") return response.end(readFileSync(join(HERE, name)));
      if (request.url === "/") return response.writeHead(200, { "content-type": "text/html" }).end(PAGE);
      const file = readFileSync(join(packageFolder, name));
      return response.writeHead(200, { "content-type": TYPES[extname(name)] ?? "" }).end(file);
    } catch (error) {
      return response.writeHead(error.code === "ENOENT" ? 404 : 500).end(String(error));
    }
  });
  await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
  return {
    url: `http://127.0.0.1:${server.address().port}/`,
    close: async () => {
      await frames.return();
      server.closeAllConnections();
      server.close();
    },
  };
}

/** The content of OUT.json. `packages` is a node_modules folder; at most `most` frames. */
export async function track(video, { packages, most = Infinity }) {
  const { chromium } = await import(pathToFileURL(resolve(packages, "playwright-core/index.mjs")).href);
  const packageFolder = resolve(packages, "@mediapipe/pose");
  const { version } = JSON.parse(readFileSync(join(packageFolder, "package.json"), "utf8"));
  const server = await serve(video, packageFolder, most);
  let browser;
  try {
    browser = await chromium.launch(launchOptions([...SOFTWARE_WEBGL, ...NO_NETWORK]));
    const page = await browser.newPage();
    page.setDefaultTimeout(0);
    await page.goto(server.url);
    const { width, height, frames } = await page.evaluate(() => globalThis.trackAll());
    if (frames.length === 0) throw new Error(`${video} has no frame`);
    return {
      tool: `@mediapipe/pose ${version}`,
      browser: browser.version(),
      width,
      height,
      frames: frames.map((frame, number) => ({ frame: number, ...frame })),
    };
  } finally {
    await browser?.close();
    await server.close();
  }
}

if (realpathSync(process.argv[1]) === fileURLToPath(import.meta.url)) {
  const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: { packages: { type: "string" }, frames: { type: "string" } },
  });
  const [video, out] = positionals;
  if (!out || !values.packages) {
    console.error("usage: track.mjs VIDEO OUT.json --packages node_modules [--frames N]");
    process.exit(2);
  }
  const most = values.frames ? Number(values.frames) : Infinity;
  writeFileSync(out, JSON.stringify(await track(video, { packages: values.packages, most })));
}
