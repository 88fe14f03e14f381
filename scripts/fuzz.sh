#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs every fuzz target for some seconds, from its seeds in fuzz/corpus. Usage: scripts/fuzz.sh [SECONDS]
# What is found and the inputs on the way are kept in build/fuzz/found and build/fuzz/corpus.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds="${1:-20}"
mkdir -p build/fuzz/found
found=0
failed=()
for program in build/fuzz/fuzz/fuzz_*; do
  [[ -x "$program" ]] || continue
  found=1
  name="${program##*/fuzz_}"
  mkdir -p "build/fuzz/corpus/$name"
  folders=("build/fuzz/corpus/$name")  # the first is the one that libFuzzer writes to
  [[ ! -d "fuzz/corpus/$name" ]] || folders+=("fuzz/corpus/$name")
  echo "== $name"
  "$program" -max_total_time="$seconds" -print_final_stats=1 -verbosity=0 -timeout=10 \
    -artifact_prefix="build/fuzz/found/$name-" "${folders[@]}" || failed+=("$name")
done
if ((found == 0)); then
  echo "there is no fuzz target in build/fuzz/fuzz" >&2
  exit 1
fi
if ((${#failed[@]} > 0)); then
  echo "failed: ${failed[*]} (inputs in build/fuzz/found)" >&2
  exit 1
fi
