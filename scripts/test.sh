#!/usr/bin/env bash
# Installs what is missing, builds optimised, and runs the tests of the libraries and of the command line.
# .ci/run runs those of many seeds and large scenes, and those of the benchmarks, as well; those of whole studies run
# before the results of these are committed.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_dependencies.sh
cmake --preset release -Wno-dev --log-level=WARNING
cmake --build --preset release
ctest --preset release --label-exclude 'long|benchmarks|studies' --parallel "$(nproc)"
