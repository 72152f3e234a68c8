#!/usr/bin/env bash
# Installs what is missing, builds, and runs all tests: optimised, then with address and undefined behaviour sanitizers.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_dependencies.sh
for preset in release sanitize; do
  cmake --preset "$preset" -Wno-dev --log-level=WARNING
  cmake --build --preset "$preset"
  ctest --preset "$preset" --parallel "$(nproc)"
done
