#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a script in Blender, where there is one: blender.sh SCRIPT.py FOLDER, the folder of the recording. Status 77: skipped, with the
# reason.
set -euo pipefail
blender="${TELEMIME_BLENDER:-blender}"
if ! command -v "$blender" > /dev/null; then
  echo "skipped: Blender is not installed here. Install the packages blender and python3-numpy, or say with TELEMIME_BLENDER where it is."
  exit 77
fi
exec "$blender" --background --factory-startup --python-exit-code 1 \
  --python "$(dirname "$0")/$1" -- "$2"
