// SPDX-License-Identifier: Apache-2.0
// In the browser: MediaPipe Pose on the frames that track.mjs serves, one after the other.

const numbers = (landmarks) =>
  landmarks?.length ? landmarks.map(({ x, y, z, visibility }) => [x, y, z, visibility ?? 0]) : null;

/** Paints a served frame; gives its time in seconds. */
async function paint(canvas, response) {
  const [width, height, time] = ["width", "height", "time"].map((key) =>
    Number(response.headers.get(`x-${key}`)),
  );
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  const pixels = new Uint8ClampedArray(await response.arrayBuffer());
  const context = canvas.getContext("2d", { alpha: false, willReadFrequently: true });
  context.putImageData(new ImageData(pixels, width, height), 0, 0);
  return time;
}

/** All frames, with the landmarks that were found, and the time that each took. track.mjs calls it. */
async function trackAll() {
  const canvas = document.querySelector("canvas");
  const pose = new Pose({ locateFile: (file) => `/package/${file}` });
  pose.setOptions({ modelComplexity: 1, smoothLandmarks: true, useCpuInference: true });
  let found;
  pose.onResults((results) => (found = results));
  await pose.initialize();
  const frames = [];
  for (;;) {
    const response = await fetch("/frame");
    if (response.status === 204) break;
    if (!response.ok) throw new Error(await response.text());
    const time = await paint(canvas, response);
    found = undefined;
    const begin = performance.now();
    await pose.send({ image: canvas }, 1000 * (1 + time)); // ms; zero would stand for the clock
    const ms = performance.now() - begin;
    const { poseLandmarks, poseWorldLandmarks } = found ?? {};
    frames.push({ time, ms, image: numbers(poseLandmarks), world: numbers(poseWorldLandmarks) });
  }
  return { width: canvas.width, height: canvas.height, frames };
}
