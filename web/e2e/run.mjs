// SPDX-License-Identifier: Apache-2.0
// Some of the tests beside this file, for ctest: node e2e/run.mjs guide. Without Chromium, ffmpeg or (for rooms) their
// brokers they are skipped, with a word and status 77; where CI is set that is a failure.

import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { hasMosquitto } from "../mock/broker.mjs";
import { hasNats } from "../mock/cluster.mjs";

const chromium = process.env.TELEMIME_CHROMIUM ?? "/usr/bin/chromium";
const missing = [];
if (!existsSync(chromium)) missing.push(`Chromium (TELEMIME_CHROMIUM says where it is; now ${chromium})`);
if (spawnSync("ffmpeg", ["-version"]).error) missing.push("ffmpeg");
if (
  ["room", "room_host", "room_faults", "room_motion"].some((name) => process.argv.includes(name)) &&
  !hasMosquitto()
)
  missing.push("Mosquitto (TELEMIME_MOSQUITTO says where it is)");
if (process.argv.includes("room_cluster") && !hasNats())
  missing.push("nats-server (TELEMIME_NATS_SERVER says where it is)");
if (missing.length > 0) {
  console.log(
    `skipped: not installed here: ${missing.join(", ")}. scripts/deps.sh test installs what is missing.`,
  );
  process.exit(process.env.CI ? 1 : 77);
}
const tests = process.argv.slice(2).map((name) => new URL(`${name}.test.mjs`, import.meta.url).pathname);
const { status } = spawnSync(process.execPath, ["--test", ...tests], { stdio: "inherit" });
process.exit(status ?? 1);
