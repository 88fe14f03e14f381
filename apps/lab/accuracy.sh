#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the clips of the README's first accuracy table, tracks each with several seeds, and prints
# the table. Usage: [BUILD=build/release] [SEEDS="1 2 3"] [OPTIONS="--cues regions,contours"] apps/lab/accuracy.sh [FOLDER]
set -euo pipefail
cd "$(dirname "$0")/../.."
build="${BUILD:-build/release}"
out="${1:-out/accuracy}"
read -ra seeds <<< "${SEEDS:-1 2 3}"
read -ra options <<< "${OPTIONS:-}"

# Name of the clip, then the options of `telemime-lab synth`.
clips=(
  "raising_arms raising_arms --seed 31"
  "joy joy --seed 32"
  "exclaiming exclaiming --seed 33"
  "asking asking --seed 34"
  "desk_talk talking --seed 35 --distance 1.2"
  "two_looks talking --seed 36 --striped --light-change"
  "long_sleeves exclaiming --seed 37 --long-sleeves"
  "enter_leave talking --seed 38 --walk-in --frames 240 --background-frames 0"
  "close_webcam talking --seed 39 --distance 0.75 --background-frames 0"
)

for line in "${clips[@]}"; do
  read -ra words <<< "$line"
  name="${words[0]}"
  clip="$out/$name/clip/${words[1]}"
  if [[ ! -f "$clip/preview.png" ]]; then
    echo "making $name" >&2
    "$build/telemime-lab" synth "${words[@]:1}" --size 320x240 --no-small --quiet --out "$out/$name/clip"
  fi
  background=()
  [[ ! -f "$clip/background.mkv" ]] || background=(--background "$clip/background.mkv")
  for seed in "${seeds[@]}"; do
    run="$out/$name/$seed"
    echo "tracking $name with seed $seed" >&2
    "$build/telemime" track "$clip/video.mkv" "${background[@]}" "${options[@]}" --seed "$seed" --no-overlay --out "$run" \
      > "$out/$name/log" 2>&1
    "$build/telemime" evaluate "$run/pose.jsonl" --truth "$clip/truth.json" --json "$run/accuracy.json" \
      > /dev/null
  done
done

python3 - "$out" "${clips[@]}" << 'END'
import glob, json, sys
out, clips = sys.argv[1], sys.argv[2:]
print("| clip | 3-D, mm | plane | depth | each seed | 2-D, px | lost | truth in the stated 95 % region |")
print("| --- | --- | --- | --- | --- | --- | --- | --- |")
for name in (clip.split()[0] for clip in clips):
    runs = [json.load(open(file)) for file in sorted(glob.glob(f"{out}/{name}/*/accuracy.json"))]
    mean = lambda pick: sum(pick(run) for run in runs) / len(runs)
    error = lambda key: mean(lambda run: run["error"]["tracked"][key])
    each = ", ".join(f"{run['error']['tracked']['aligned_mm']:.0f}" for run in runs)
    print(f"| {name} | {error('aligned_mm'):.0f} | {error('aligned_image_plane_mm'):.0f} | "
          f"{error('aligned_depth_mm'):.0f} | {each} | {error('image_px'):.1f} | "
          f"{100 * mean(lambda run: run['lost']['scored_frames']):.0f} % | "
          f"{100 * mean(lambda run: run['spread']['covered']):.0f} % |")
END
