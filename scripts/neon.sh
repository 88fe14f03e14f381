#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compiles the vector kernel for 64-bit Arm, so that a change which only x86 takes is noticed. Nothing is run.
set -euo pipefail
cd "$(dirname "$0")/.."
object="$(mktemp)"
trap 'rm -f "$object"' EXIT
aarch64-linux-gnu-g++ -std=c++20 -O3 -march=armv8-a+crypto -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -Werror \
  -Isrc -isystem /usr/include/opencv4 -isystem /usr/include/eigen3 -c src/telemime/likelihood/simd/kernel.cpp \
  -o "$object"
# Not `grep -q`: it ends at its first match, and pipefail would then count the signal that stops nm as a failure.
aarch64-linux-gnu-nm -C "$object" | grep "N_NEON::count_pose" > /dev/null || {
  echo "neon: there is no kernel for NEON in the object" >&2
  exit 1
}
echo "neon: the kernel compiles"
