// SPDX-License-Identifier: Apache-2.0
// node extract_models.mjs TABLE PACKAGES FOLDER: writes the networks of TABLE (src/telemime/nets/models/table.inc) to FOLDER
// as NAME.tflite, taken from PACKAGES/@mediapipe. A file of a package can contain several networks, one after another.
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const [table, packages, folder] = process.argv.slice(2);
const rows = [...readFileSync(table, "utf8").matchAll(/\{"(\w+)", "([\w./]+)", (\d+), "([0-9a-f]{64})"\}/g)];

/** The network of this size and SHA-256 in the bytes, which begins four bytes before its identifier. */
function networkIn(bytes, size, sha256) {
  for (let at = bytes.indexOf("TFL3"); at >= 4; at = bytes.indexOf("TFL3", at + 1)) {
    const part = bytes.subarray(at - 4, at - 4 + size);
    if (part.length === size && createHash("sha256").update(part).digest("hex") === sha256) {
      return part;
    }
  }
  return undefined;
}

if (rows.length === 0) {
  console.error(`there is no network in ${table}`);
  process.exit(1);
}
const files = new Map();
mkdirSync(folder, { recursive: true });
for (const [, name, file, size, sha256] of rows) {
  if (!files.has(file)) {
    files.set(file, readFileSync(join(packages, "@mediapipe", file)));
  }
  const network = networkIn(files.get(file), Number(size), sha256);
  if (!network) {
    console.error(`${file} of the package does not contain the network ${name} that ${table} describes`);
    process.exit(1);
  }
  writeFileSync(join(folder, `${name}.tflite`), network);
}
const names = new Set(rows.map(([, name]) => `${name}.tflite`));
for (const entry of readdirSync(folder)) {
  if (entry.endsWith(".tflite") && !names.has(entry)) {
    rmSync(join(folder, entry));
  }
}
