#!/usr/bin/env bash
# Installs what is missing, builds, and estimates Young's modulus and Poisson's ratio of the bundled scene.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_dependencies.sh
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { cmake --preset release -Wno-dev && cmake --build --preset release --target elastimate; } >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi

elastimate=build/release/apps/elastimate
for arguments in \
  "examples/scenes/organ.vtu --estimator=reduced-fe" \
  "examples/scenes/organ.vtu"; do
  echo
  echo "\$ elastimate estimate $arguments"
  # shellcheck disable=SC2086
  "$elastimate" estimate $arguments || true
done
