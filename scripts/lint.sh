#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# clang-format and clang-tidy, as many at a time as there are processors. Usage: scripts/lint.sh [FILE...]
# Without files: every C++ file, with all rules of .clang-tidy. With TELEMIME_LINT_QUICK=1: every C++ file except tests
# (half of the time, fewest findings), with the rules that find most in the least time, on the groups of files that
# cmake/TelemimeUnity.cmake makes. What passed is not read again until it, a header of this project that it includes,
# the rules or the compiler's options change (stamps in $TELEMIME_LINT_CACHE).
set -euo pipefail
cd "$(dirname "$0")/.."
export TELEMIME_LINT_QUICK="${TELEMIME_LINT_QUICK:-}"
preset=lint${TELEMIME_LINT_QUICK:+-quick}
export build="${TELEMIME_LINT_BUILD:-build/$preset}"
export TELEMIME_LINT_CACHE="${TELEMIME_LINT_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/telemime-lint}"
mkdir -p "$TELEMIME_LINT_CACHE"
cmake --preset "$preset" > "$TELEMIME_LINT_CACHE/configure.log" || { cat "$TELEMIME_LINT_CACHE/configure.log"; exit 1; }

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
  sed -n "s|^  \"command\": \"\(.*\) -o .* -c $PWD/$1\",\{0,1\}$|\1|p; T; q" "$build/compile_commands.json" |
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
    checks="--checks=-*,bugprone-use-after-move,bugprone-dangling-handle,bugprone-sizeof-expression,\
bugprone-integer-division,bugprone-misplaced-widening-cast,performance-*,-performance-no-int-to-ptr,-performance-inefficient-vector-operation,\
-performance-inefficient-string-concatenation,-performance-no-automatic-move,-performance-unnecessary-copy-initialization,\
-performance-unnecessary-value-param,readability-braces-around-statements,misc-unused-parameters,\
modernize-use-override"
  elif [[ "$file" == *_test.cpp ]]; then
    # In the macros of tests most checks take long and find nothing worth it.
    checks="--checks=-*,bugprone-use-after-move,bugprone-unused-return-value,bugprone-sizeof-expression,\
performance-move-const-arg,performance-for-range-copy,modernize-use-nullptr,readability-braces-around-statements"
  fi
  # -MM lists the file and the project's own headers.
  # shellcheck disable=SC2086
  key="$({
    clang-tidy-14 --version; cat .clang-tidy; echo "$checks $options"
    eval clang++-14 $options -MM "$file" | tr -d '\\' | tr ' ' '\n' | grep -E '\.(h|cpp|cxx|inc)$' | sort -u | xargs cat
  } | sed "s|$PWD||g" | sha256sum | cut -d' ' -f1)"
  [[ -e "$TELEMIME_LINT_CACHE/$key" ]] && return 0
  if ! clang-tidy-14 -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option ${checks:+"$checks"} "$file" \
    2> >(grep -vE '^[0-9]+ warnings? (and [0-9]+ errors? )?generated|^Suppressed|^Use -header' >&2); then
    echo "lint: clang-tidy refuses $file" >&2
    return 1
  fi
  touch "$TELEMIME_LINT_CACHE/$key"
}
export -f tidy_one options_of

if [[ -n "$TELEMIME_LINT_QUICK" ]]; then
  mapfile -t sources < <(sed -n "s|^  \"file\": \"$PWD/\(.*\)\".*|\1|p" "$build/compile_commands.json" | sort -u |
    grep -vE '/(pch|page_table)\.cpp$|_test\.(dir|cpp)|(^|/)tests/')
else
  mapfile -t sources < <(printf '%s\n' "${files[@]}" | grep '\.cpp$' || true)
fi
echo "lint: clang-tidy of ${#sources[@]} files or groups of files"
((${#sources[@]} == 0)) || printf '%s\0' "${sources[@]}" |
  xargs -0 -n 1 -P "$(nproc)" bash -c 'set -euo pipefail; tidy_one "$0"'
echo "lint: clean"
