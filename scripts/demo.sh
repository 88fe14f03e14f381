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
# The limits are those of tests/accuracy.
python3 - "$out/accuracy.json" << 'END'
import json, sys
result = json.load(open(sys.argv[1]))
tracked = result["error"]["tracked"]
if tracked["aligned_mm"] > 45 or tracked["image_px"] > 3.5 or result["lost"]["all_frames"] or result["swapped"]["frames"]:
    sys.exit("demo: the error is above its limit (45 mm, 3.5 px, no lost frame, no exchanged arms)")
END
echo
echo "Results are in $out:"
ls -1 "$out" | sed 's/^/  /'
echo "Look at $out/overlay.png: the tracked body drawn over the video."
