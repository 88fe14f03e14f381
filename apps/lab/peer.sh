#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tracks clips with Telemime and with the peer, MediaPipe Pose (full), and prints in Markdown the errors of both and the time
# of a frame. Usage, with everything in brackets optional:
#   [BUILD=build/release] [SEED=1] [OPTIONS="--quality best"] [CLIPS="joy asking"] [FOLDERS="DIR DIR"] [ROUNDS=5] \
#   apps/lab/peer.sh [FOLDER]
# CLIPS are names of clips.sh, all by default; the clips are made in out/accuracy. With PEOPLE, the folder that
# apps/lab/people.sh prints, they are clips of people of meshes. Each of FOLDERS has a clip (video.* or
# clip.*), truth.json and perhaps background.* and camera.*; by default they are those of TELEMIME_DATA, if there are such.
# ROUNDS is how often the time is measured, on the clip of the demo and without OPTIONS; 0 leaves it out.
set -euo pipefail
cd "$(dirname "$0")/../.."
build="${BUILD:-build/release}"
out="${1:-out/peer}"
seed="${SEED:-1}"
read -ra options <<< "${OPTIONS:-}"
# shellcheck source=apps/lab/clips.sh
source apps/lab/clips.sh
read -ra names <<< "${CLIPS-${clips[*]%% *}}"
data="${TELEMIME_DATA:-../shared/data}"
folders=()
for truth in "$data"/{dev,dev_practical,real}/*/truth.json; do
  [[ ! -f "$truth" ]] || folders+=("$(dirname "$truth")")
done
[[ -z "${FOLDERS+set}" ]] || read -ra folders <<< "$FOLDERS"
tools=apps/lab/peer

fail() {
  echo "peer: $*" >&2
  exit 1
}
for name in "${names[@]}"; do
  [[ " ${clips[*]%% *} " == *" $name "* ]] || fail "no clip is called $name; there are ${clips[*]%% *}"
done
chromium="${TELEMIME_CHROMIUM:-/usr/bin/chromium}"
[[ -x "$chromium" ]] ||
  fail "Chromium is missing (TELEMIME_CHROMIUM names it; now $chromium). scripts/deps.sh page test installs it."
for program in node npm ffmpeg ffprobe "$build/telemime" "$build/telemime-lab"; do
  command -v "$program" > /dev/null ||
    fail "$program is missing. scripts/deps.sh page test installs what is missing, make peer also builds the programs."
done

# The packages are in the build folder, as those of the page are. The program does not need them.
packages="$build/peer/node_modules"
if ! cmp -s "$tools/package-lock.json" "$build/peer/fetched.json"; then
  echo "fetching the peer with npm (63 MB unpacked)" >&2
  mkdir -p "$build/peer"
  cp "$tools/package.json" "$tools/package-lock.json" "$build/peer"
  (cd "$build/peer" && npm ci --ignore-scripts --no-audit --no-fund --no-update-notifier > npm.log 2>&1) ||
    { cat "$build/peer/npm.log" >&2; fail "npm could not fetch the peer. It needs the network once."; }
  cp "$tools/package-lock.json" "$build/peer/fetched.json"
fi

# run_peer CLIP RESULT ARGUMENT...
run_peer() {
  node "$tools/track.mjs" "$(file_of "$1" video clip)" "$2" --packages "$packages" "${@:3}"
}

# compare NAME CLIP HERE: tracks the clip with both and scores both in the folder HERE, which it adds to `results`.
compare() {
  local clip="$2" here="$3"
  [[ -n "$(file_of "$clip" video clip)" && -f "$clip/truth.json" ]] ||
    fail "$clip has no video.* or clip.*, or no truth.json"
  [[ " ${results[*]} " != *" $here "* ]] || fail "two folders are called $1"
  echo "tracking $1" >&2
  mkdir -p "$here"
  track_clip "$here/telemime" "$clip" --seed "$seed" > "$here/log" 2>&1 || { cat "$here/log" >&2; fail "$1 failed"; }
  run_peer "$clip" "$here/peer.json"
  node "$tools/as_pose_file.mjs" "$here/peer.json" "$clip/truth.json" "$here"
  score "$here/telemime/pose.jsonl" "$here/truth.json" "$here/telemime_accuracy.json"
  score "$here/pose.jsonl" "$here/truth.json" "$here/peer_accuracy.json"
  results+=("$here")
}
print_errors() {
  ((${#results[@]} == 0)) || { node "$tools/table.mjs" errors "${results[@]}"; echo; }
}

results=()
for line in "${clips[@]}"; do
  name="${line%% *}"
  [[ " ${names[*]} " == *" $name "* ]] || continue
  make_clip "$line" out/accuracy
  compare "$name" "$clip" "$out/clips/$name"
done
print_errors
results=()
for folder in "${folders[@]}"; do
  name="$(basename "$folder")"
  compare "$name" "$folder" "$out/folders/$name"
done
print_errors

# measure_time NAME THREADS OPTION...
measure_time() {
  OPENCV_FOR_THREADS_NUM="$2" track_clip "$here/$round/$1" data/demo --quality balanced --frames 80 --threads "$2" \
    --set calibration.look_ahead=0 --formats jsonl --seed "$seed" "${@:3}" > "$here/log" 2>&1 ||
    { cat "$here/log" >&2; fail "the time could not be measured"; }
}

# In turn, on few frames, so that other work on the computer disturbs all alike. Without the look-ahead, which fits the body
# once before the first frame and changes nothing in the time of the others. The peer finds neither hands nor expressions: both
# are left out but for the last run.
here="$out/times"
rm -rf "$here"
options=()
rounds="${ROUNDS:-5}"
for ((round = 1; round <= rounds; ++round)); do
  echo "measuring times: round $round of $rounds" >&2
  mkdir -p "$here/$round"
  run_peer data/demo "$here/$round/peer.json" --frames 80
  for threads in 1 0; do
    measure_time "threads_$threads" "$threads" --no-face --no-hands
  done
  measure_time whole 0
done
if ((rounds > 0)); then
  echo "Times on $(nproc) processors; load of the last minute: $(cut -d ' ' -f 1 /proc/loadavg)"
  echo
  node "$tools/table.mjs" times "$here"/*/
fi
