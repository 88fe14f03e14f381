// SPDX-License-Identifier: Apache-2.0
// Runs end-to-end tests for ctest: node web/e2e/run.mjs web/e2e/guide. A folder stands for all of its tests. Without Chromium,
// ffmpeg or the broker of a meeting they are skipped with status 77; where CI is set that is a failure.

import { spawnSync } from "node:child_process";
import { existsSync, readdirSync } from "node:fs";
import { CHROMIUM } from "./chromium.mjs";

const env = { ...process.env, PATH: `${process.env.PATH}:/usr/sbin` };
const installed = (command, ...args) => !spawnSync(command, args, { env }).error;

const tests = process.argv.slice(2).flatMap((path) =>
  existsSync(path)
    ? readdirSync(path)
        .filter((name) => name.endsWith(".test.mjs"))
        .map((name) => `${path}/${name}`)
    : [`${path}.test.mjs`],
);
const meetings = tests.filter((t) => t.startsWith("meeting/"));
const clusters = meetings.filter((t) => t.includes("cluster"));
const mosquitto = process.env.TELEMIME_MOSQUITTO ?? "mosquitto";
const nats = process.env.TELEMIME_NATS_SERVER ?? "nats-server";
const missing = [
  !existsSync(CHROMIUM) && `Chromium (TELEMIME_CHROMIUM names it; now ${CHROMIUM})`,
  !installed("ffmpeg", "-version") && "ffmpeg",
  meetings.length > clusters.length &&
    !installed(mosquitto, "-h") &&
    "Mosquitto (TELEMIME_MOSQUITTO names it)",
  clusters.length > 0 && !installed(nats, "--version") && "nats-server (TELEMIME_NATS_SERVER names it)",
].filter(Boolean);
if (missing.length > 0) {
  console.log(
    `skipped, not installed: ${missing.join(", ")}. scripts/deps.sh test installs what is missing.`,
  );
  process.exit(process.env.CI ? 1 : 77);
}
const { status } = spawnSync(process.execPath, ["--test", ...tests], { stdio: "inherit" });
process.exit(status ?? 1);
