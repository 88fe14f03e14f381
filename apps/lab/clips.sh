# SPDX-License-Identifier: Apache-2.0
# The clips of the tables in docs/accuracy.md, how they are made and how a clip is tracked: for accuracy.sh and peer.sh, which set
# `build`, the folder of the programs, and `options`, further options of `telemime track`.
# shellcheck shell=bash disable=SC2034,SC2154

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

# With PEOPLE, the folder that people.sh prints, clips of people of meshes instead.
common=(--size 320x240 --no-small --quiet)
if [[ -n "${PEOPLE:-}" ]]; then
  common=(--people "$PEOPLE" --fingers --frames 100 --background-frames 0 --no-small --quiet)
  clips=(
    "person_1 raising_arms --seed 6001 --long-sleeves"
    "person_2 joy --seed 6002"
    "person_3 exclaiming --seed 6003 --distance 1.0"
    "person_4 asking --seed 6004 --long-sleeves"
    "person_5 talking --seed 6005 --distance 0.8"
    "person_6 raising_arms --seed 6006 --distance 1.6"
    "person_7 joy --seed 6007 --long-sleeves --distance 1.5"
    "person_8 exclaiming --seed 6008 --long-sleeves"
    "person_9 asking --seed 6009 --distance 1.6"
    "person_10 talking --seed 6010 --long-sleeves --look-around --distance 1.0"
  )
fi

# make_clip "NAME SYNTH_OPTIONS..." FOLDER: makes the clip of a line of `clips` unless it is there, made with the same options.
# Sets `clip`, its folder.
make_clip() {
  local words made_with="$1 ${common[*]}"
  read -ra words <<< "$1"
  clip="$2/${words[0]}/clip/${words[1]}"
  if [[ "$(cat "$clip/made_with" 2> /dev/null)" != "$made_with" ]]; then
    echo "making ${words[0]}" >&2
    rm -f "$clip/made_with"
    "$build/telemime-lab" synth "${words[@]:1}" "${common[@]}" --out "$2/${words[0]}/clip"
    echo "$made_with" > "$clip/made_with"
  fi
}

# file_of FOLDER NAME...: the first file with one of these names and any ending, or nothing.
file_of() {
  local name file
  for name in "${@:2}"; do
    for file in "$1/$name".*; do
      [[ ! -f "$file" ]] || { echo "$file"; return; }
    done
  done
}

# track_clip RUN CLIP ARGUMENT...: tracks the video in the folder CLIP, with its background and camera if it has them;
# results in the folder RUN.
track_clip() {
  local background camera arguments
  background="$(file_of "$2" background)"
  camera="$(file_of "$2" camera)"
  arguments=("$(file_of "$2" video clip)")
  [[ -z "$background" ]] || arguments+=(--background "$background")
  [[ -z "$camera" ]] || arguments+=(--camera "$camera")
  "$build/telemime" track "${arguments[@]}" "${options[@]}" "${@:3}" --no-overlay --out "$1"
}

# score POSE TRUTH RESULT
score() {
  "$build/telemime" evaluate "$1" --truth "$2" --json "$3" > /dev/null
}
