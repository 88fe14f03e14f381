#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Removes what `make install` installed last: the files listed in its manifest, their compiled Python files, and folders of
# Telemime that are then empty. Usage: [DESTDIR=DIR] scripts/uninstall.sh [BUILD]
set -euo pipefail
cd "$(dirname "$0")/.."
manifest="${1:-build/release}/installed_by_make.txt"  # of the install target; other installations have their own
if [[ ! -f "$manifest" ]]; then
  echo "uninstall: nothing has been installed from here ($manifest does not exist)" >&2
  exit 1
fi
mapfile -t files < "$manifest"
declare -A folders=()
count=0
for file in "${files[@]}"; do
  file="${DESTDIR:-}$file"
  if [[ -e "$file" || -L "$file" ]]; then
    rm -- "$file"
    count=$((count + 1))
  fi
  folder="${file%/*}"
  if [[ "$file" == *.py ]]; then
    name="${file##*/}"
    rm -f -- "$folder/__pycache__/${name%.py}".*.pyc
    folders["$folder/__pycache__"]=1
  fi
  # Folders that others may use have another name before them.
  while [[ "$folder" == */telemime || "$folder" == */telemime/* ]]; do
    folders["$folder"]=1
    folder="${folder%/*}"
  done
done
# The inner ones first.
printf '%s\n' "${!folders[@]}" | sort -r | while read -r folder; do
  [[ ! -d "$folder" ]] || rmdir --ignore-fail-on-non-empty -- "$folder"
done
rm -- "$manifest"
echo "uninstall: $count files removed"
