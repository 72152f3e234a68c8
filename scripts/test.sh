#!/usr/bin/env bash
# Installs what is missing, builds optimised, and runs the tests of the libraries and of the command line.
# The benchmarks and their tests are built by .ci/run.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_dependencies.sh
cmake --preset release -Wno-dev --log-level=WARNING
cmake --build --preset release
ctest --preset release --parallel "$(nproc)"
