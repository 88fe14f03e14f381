#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs every program of a folder with the same arguments. Usage: scripts/each.sh FOLDER [ARGUMENT...]
set -euo pipefail
folder="$1"
shift
found=0
while IFS= read -r program; do
  found=1
  echo "== $program"
  "$program" "$@"
done < <(find "$folder" -maxdepth 1 -type f -executable 2>/dev/null | sort)
if ((found == 0)); then
  echo "there is no program in $folder" >&2
  exit 1
fi
