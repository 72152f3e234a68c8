#!/usr/bin/env bash
# Checks the format and the static analysis of all sources, after a release build (which writes the compile commands).
# Arguments: the sources to analyse; all by default.
set -euo pipefail
cd "$(dirname "$0")/.."

git ls-files '*.cc' '*.h' | xargs clang-format --dry-run --Werror
if [ $# -eq 0 ]; then
  mapfile -t sources < <(git ls-files '*.cc' ':!examples')
else
  sources=("$@")
fi
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build/release --quiet 2> >(grep -v 'warnings generated' >&2)
