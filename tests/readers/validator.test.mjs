// SPDX-License-Identifier: Apache-2.0
// The Khronos validator on all glTF that the program writes: the recording's GLB and VRMA, and every avatar.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { test } from "node:test";
import { bytes, folder, load, needed } from "./recording.mjs";

const { validateBytes } = await load("gltf-validator/module.mjs");
const program = needed("TELEMIME_PROGRAM");
const looks = execFileSync(program, ["avatar", "--list"], { encoding: "utf8" })
  .trim()
  .split("\n")
  .map((line) => line.split(":")[0]);

async function valid(name) {
  const { issues } = await validateBytes(new Uint8Array(bytes(name)), { uri: name, maxIssues: 1000 });
  const count = `${issues.numErrors} errors, ${issues.numWarnings} warnings, ${issues.numInfos} notes`;
  console.log(`${name}: ${count}`);
  const seen = new Map();
  for (const m of issues.messages) {
    const words = `  ${["error", "warning", "note", "hint"][m.severity]} ${m.code}: ${m.message}`;
    seen.set(words, [...(seen.get(words) ?? []), m.pointer]);
  }
  for (const [words, where] of seen) console.log(`${words} (${where.length} times, first ${where[0]})`);
  assert.equal(issues.numErrors, 0, name);
}

for (const name of ["motion.glb", "motion.vrma"]) test(name, () => valid(name));

test("there are avatars", () => assert.ok(looks.length >= 2, `${looks}`));

for (const look of looks) {
  test(`avatar ${look}`, async () => {
    execFileSync(program, ["avatar", "--look", look, "--out", join(folder, `${look}.vrm`)]);
    await valid(`${look}.vrm`);
  });
}
