#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs every apps/lab/published/<name>/run (or only those named) with $TELEMIME, the program, set.
set -euo pipefail
cd "$(dirname "$0")/../.."
export TELEMIME="${TELEMIME:-$PWD/build/release/telemime-lab}"
if (($# == 0)); then
  mapfile -t names < <(find apps/lab/published -mindepth 2 -maxdepth 2 -name run -executable -printf '%h\n' |
    sed 's|^apps/lab/published/||' | sort)
else
  names=("$@")
fi
if ((${#names[@]} == 0)); then
  echo "there is no apps/lab/published/*/run" >&2
  exit 1
fi
for name in "${names[@]}"; do
  echo "== $name"
  "apps/lab/published/$name/run"
done
