#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tracks the clip in data/demo, scores the result against its ground truth, and fails when the error is too large.
set -euo pipefail
cd "$(dirname "$0")/.."
telemime="${TELEMIME:-build/release/telemime}"
out="${1:-out/demo}"

one() {
  local files=("$1".*)
  if [[ ! -f "${files[0]}" ]]; then
    echo "demo: $1.* is missing; is this a whole copy of the repository?" >&2
    exit 1
  fi
  echo "${files[0]}"
}
video="$(one data/demo/video)"
background="$(one data/demo/background)"

mkdir -p "$out"
echo "== $telemime track $video --background $background --out $out"
"$telemime" track "$video" --background "$background" --out "$out"
echo "== $telemime evaluate $out/pose.jsonl --truth data/demo/truth.json"
"$telemime" evaluate "$out/pose.jsonl" --truth data/demo/truth.json --json "$out/accuracy.json"

for result in "$out/pose.jsonl" "$out/overlay.png"; do
  if [[ ! -s "$result" ]]; then
    echo "demo: $result was not written" >&2
    exit 1
  fi
done
python3 scripts/demo_limits.py "$out/accuracy.json"
echo
echo "Results are in $out:"
ls -1 "$out" | sed 's/^/  /'
echo "Look at $out/overlay.png: the tracked body drawn over the video."
