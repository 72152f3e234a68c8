#!/usr/bin/env bash
# Checks the format and the static analysis of all sources.
# Arguments: the sources to analyse; all by default.
set -euo pipefail
cd "$(dirname "$0")/.."

git ls-files '*.cc' '*.h' | xargs clang-format --dry-run --Werror
if [ $# -eq 0 ]; then
  mapfile -t sources < <(git ls-files '*.cc' ':!examples')
else
  sources=("$@")
fi
# clang cannot read the headers that gcc has precompiled, and each source is analysed by itself.
cmake --preset release -B build/lint -D CMAKE_DISABLE_PRECOMPILE_HEADERS=ON -D CMAKE_UNITY_BUILD=OFF -Wno-dev --log-level=WARNING >/dev/null
cmake --build build/lint --target elastimate_commit >/dev/null
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build/lint --quiet 2> >(grep -v 'warnings generated' >&2)
