#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# clang-format and clang-tidy, as many at a time as there are processors. Usage: scripts/lint.sh [FILE...]
# Without files: every C++ file. A file that passed is not looked at again until it, a header of this project that
# it includes, the rules or the compiler's options change (stamps in $TELEMIME_LINT_CACHE). TELEMIME_LINT_QUICK=1
# is for a machine that has no stamps and little time: the checks that find most, in the rooms that track.
set -euo pipefail
cd "$(dirname "$0")/.."
build="${TELEMIME_LINT_BUILD:-build/lint}"
export TELEMIME_LINT_CACHE="${TELEMIME_LINT_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/telemime-lint}"
export build
export TELEMIME_LINT_QUICK="${TELEMIME_LINT_QUICK:-}"

if [[ ! -f "$build/compile_commands.json" ]]; then
  echo "lint: $build is not configured; run: cmake --preset lint" >&2
  exit 1
fi
mkdir -p "$TELEMIME_LINT_CACHE"

if (($# > 0)); then
  files=("$@")
else
  mapfile -t files < <(git ls-files --cached --others --exclude-standard -- '*.h' '*.cpp' | sort -u |
    while read -r file; do [[ -f "$file" ]] && echo "$file"; done)
fi
((${#files[@]} > 0)) || exit 0
echo "lint: format of ${#files[@]} files"
printf '%s\0' "${files[@]}" | xargs -0 -n 50 clang-format-14 --dry-run -Werror

# The compiler's options for one file, without what only a build needs.
options_of() {
  sed -n "s|^  \"command\": \"\(.*\) -o .* -c $PWD/$1\",\{0,1\}$|\1|p" "$build/compile_commands.json" | head -1 |
    sed 's|\\"|"|g; s|\\\\|\\|g' | { grep -oE -- '-(D|I|isystem |std=)[^ ]+' || true; } | tr '\n' ' '
}

tidy_one() {
  local file="$1" checks="" options key
  options="$(options_of "$file")"
  if [[ -z "$options" ]]; then
    echo "lint: $file is in no target of $build; skipped (is its option off?)"
    return 0
  fi
  if [[ -n "$TELEMIME_LINT_QUICK" ]]; then
    case "$file" in
      *_test.cpp | tests/* | apps/* | examples/* | bench/* | src/telemime/experiments/* | src/telemime/synth/*) return 0 ;;
    esac
    # Without those that take half of the time and seldom find anything.
    look_at "$file" "--checks=-*,bugprone-use-after-move,bugprone-dangling-handle,bugprone-sizeof-expression,\
bugprone-integer-division,bugprone-misplaced-widening-cast,performance-*,-performance-no-int-to-ptr,\
-performance-unnecessary-value-param,readability-braces-around-statements,misc-unused-parameters,\
modernize-use-override"
    return
  fi
  # In the macros of tests most checks take long and find nothing worth it.
  [[ "$file" == *_test.cpp ]] && checks="--checks=-*,bugprone-use-after-move,bugprone-unused-return-value,\
bugprone-sizeof-expression,performance-move-const-arg,performance-for-range-copy,modernize-use-nullptr,\
readability-braces-around-statements"
  # -MM lists the file and the project's own headers.
  # shellcheck disable=SC2086
  key="$({
    clang-tidy-14 --version; cat .clang-tidy; echo "$checks $options"
    eval clang++-14 $options -MM "$file" | tr -d '\\' | tr ' ' '\n' | grep -E '\.(h|cpp)$' | sort -u | xargs cat
  } | sed "s|$PWD||g" | sha256sum | cut -d' ' -f1)"
  [[ -e "$TELEMIME_LINT_CACHE/$key" ]] && return 0
  look_at "$file" "$checks" && touch "$TELEMIME_LINT_CACHE/$key"
}

look_at() {
  local file="$1" checks="$2"
  if ! clang-tidy-14 -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option ${checks:+"$checks"} "$file" \
    2> >(grep -vE '^[0-9]+ warnings? (and [0-9]+ errors? )?generated|^Suppressed|^Use -header' >&2); then
    echo "lint: clang-tidy refuses $file" >&2
    return 1
  fi
}
export -f tidy_one look_at options_of

mapfile -t sources < <(printf '%s\n' "${files[@]}" | grep '\.cpp$' || true)
echo "lint: clang-tidy of ${#sources[@]} files"
((${#sources[@]} == 0)) || printf '%s\0' "${sources[@]}" |
  xargs -0 -n 1 -P "$(nproc)" bash -c 'set -euo pipefail; tidy_one "$0"'
echo "lint: clean"
