#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian packages of scripts/packages.txt that are missing, and names those that are there in another version.
# Usage: scripts/deps.sh [build] [test] [check]
set -euo pipefail
list="$(dirname "$0")/packages.txt"
uses="${*:-build}"

missing=() others=()
while read -r use name version command; do
  [[ "$use" != "#"* && -n "$name" && " $uses " == *" $use "* ]] || continue
  if [[ "$version" == command=* ]]; then
    command="$version" version=""
  fi
  if [[ -n "$command" ]] && command -v "${command#command=}" > /dev/null; then
    continue
  fi
  installed="$(dpkg-query -W -f '${db:Status-Abbrev}${Version}\n' "$name" 2>/dev/null | head -1 || true)"
  # shellcheck disable=SC2053  # the version is a pattern
  if [[ "$installed" != ?"i "* ]]; then
    missing+=("$name${version:+=$version}")
  elif [[ "${installed#* }" != ${version:-*} ]]; then
    others+=("$name ${installed#* }")
  fi
done < "$list"
if ((${#others[@]} > 0)); then
  words="$(printf ', %s' "${others[@]}")"
  echo "deps: Telemime is tested with other versions (scripts/packages.txt) than these: ${words#, }" >&2
fi
if ((${#missing[@]} == 0)); then
  exit 0
fi

if ! command -v apt-get > /dev/null; then
  echo "deps: this is not Debian; install by hand what scripts/packages.txt names" >&2
  exit 1
fi
as_root=()
if ((EUID != 0)); then
  if ! command -v sudo > /dev/null; then
    echo "deps: as root, run: apt-get update && apt-get install ${missing[*]%%=*}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
export DEBIAN_FRONTEND=noninteractive
echo "deps: installing ${missing[*]}"
"${as_root[@]}" apt-get update -q
install() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends "$@"
}
if ! install "${missing[@]}"; then
  echo "deps: these versions are not offered here (Debian 12 has them); taking what is" >&2
  install "${missing[@]%%=*}"
fi
