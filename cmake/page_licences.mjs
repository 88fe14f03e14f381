// SPDX-License-Identifier: Apache-2.0
// node page_licences.mjs NOTICE LOCK PACKAGES FILE: writes to FILE the copyright of the program as it is installed: NOTICE,
// and the licences of the npm packages of LOCK that the pages contain or that the models come from, found in PACKAGES.
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const [notice, lock, packages, file] = process.argv.slice(2);
// "node_modules/a/node_modules/b" is the package b as a alone uses it.
const typesOnly = /^node_modules\/(@types\/.*|typescript|undici-types)$/;
const used = Object.entries(JSON.parse(readFileSync(lock, "utf8")).packages).filter(
  ([path, entry]) => path !== "" && !entry.dev && !entry.optional && !typesOnly.test(path),
);

let text =
  readFileSync(notice, "utf8").trimEnd() +
  "\n\nOn Debian the Apache License, Version 2.0, is the file /usr/share/common-licenses/Apache-2.0.\n\n" +
  "The pages contain code of these npm packages; the neural networks come from those of @mediapipe.\n";
for (const [path, entry] of used) {
  const folder = join(packages, path.replace(/^node_modules\//, ""));
  const licence = readdirSync(folder).find((name) => /^(licen[cs]e|copying)(\.(md|txt|mit))?$/i.test(name));
  text += `\n${"-".repeat(80)}\n${path.split("node_modules/").at(-1)} ${entry.version}: ${entry.license}\n`;
  if (licence) {
    text += "\n" + readFileSync(join(folder, licence), "utf8").replace(/\r/g, "").trim() + "\n";
  } else if (!entry.license) {
    console.error(`${folder} states no licence`);
    process.exit(1);
  }
}
writeFileSync(file, text);
