#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the clips of docs/accuracy.md, tracks each with several seeds, and prints
# the table. Usage: [BUILD=build/release] [SEEDS="1 2 3"] [OPTIONS="--cues regions,contours"] apps/lab/accuracy.sh [FOLDER]
# With PEOPLE, the folder that apps/lab/people.sh prints, the clips are of people of meshes.
set -euo pipefail
cd "$(dirname "$0")/../.."
build="${BUILD:-build/release}"
out="${1:-out/accuracy}"
read -ra seeds <<< "${SEEDS:-1 2 3}"
read -ra options <<< "${OPTIONS:-}"

# shellcheck source=apps/lab/clips.sh
source apps/lab/clips.sh

for line in "${clips[@]}"; do
  name="${line%% *}"
  make_clip "$line" "$out"
  for seed in "${seeds[@]}"; do
    run="$out/$name/$seed"
    echo "tracking $name with seed $seed" >&2
    track_clip "$run" "$clip" --seed "$seed" > "$out/$name/log" 2>&1 ||
      { cat "$out/$name/log" >&2; echo "accuracy: $name failed with seed $seed" >&2; exit 1; }
    score "$run/pose.jsonl" "$clip/truth.json" "$run/accuracy.json"
  done
done

python3 - "$out" "${seeds[*]}" "${clips[@]}" << 'END'
import json, sys
out, seeds, clips = sys.argv[1], sys.argv[2].split(), sys.argv[3:]
print("| clip | 3-D, mm | plane | depth | each seed | 2-D, px | lost | truth in the stated 95 % region |")
print("| --- | --- | --- | --- | --- | --- | --- | --- |")
for name in (clip.split()[0] for clip in clips):
    runs = [json.load(open(f"{out}/{name}/{seed}/accuracy.json")) for seed in seeds]
    def mean(pick, places=0, factor=1):
        """Over the runs that have this number, in words."""
        known = [number for number in map(pick, runs) if number is not None]
        return f"{factor * sum(known) / len(known):.{places}f}" if known else "-"
    error = lambda key, places=0: mean(lambda run: run["error"]["tracked"][key], places)
    each = ", ".join("-" if run["error"]["tracked"]["aligned_mm"] is None else f"{run['error']['tracked']['aligned_mm']:.0f}" for run in runs)
    print(f"| {name} | {error('aligned_mm')} | {error('aligned_image_plane_mm')} | {error('aligned_depth_mm')} | {each} | "
          f"{error('image_px', 1)} | {mean(lambda run: run['lost']['scored_frames'], factor=100)} % | "
          f"{mean(lambda run: run['spread']['covered'], factor=100)} % |")
END
