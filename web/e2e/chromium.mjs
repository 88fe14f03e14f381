// SPDX-License-Identifier: Apache-2.0
// Where Chromium is and how it starts, for tests and measurements. It imports nothing: others bring playwright-core.

export const CHROMIUM = process.env.TELEMIME_CHROMIUM ?? "/usr/bin/chromium";

// As on a computer without a graphics card: WebGL in software, the page itself drawn without it.
export const SOFTWARE_WEBGL = ["--enable-unsafe-swiftshader"];

/** Options of playwright-core's chromium.launch(). */
export const launchOptions = (args = SOFTWARE_WEBGL) => ({
  executablePath: CHROMIUM,
  args: ["--no-sandbox", ...args],
});
