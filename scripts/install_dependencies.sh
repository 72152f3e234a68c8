#!/usr/bin/env bash
# Installs the Debian 12 packages that elastimate is built with; does nothing, and uses no network, when all are there.
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libboost-dev libceres-dev libeigen3-dev libsuitesparse-dev libopenblas-pthread-dev
  libhwy-dev libnanoflann-dev libgoogle-glog-dev libgflags-dev libgtest-dev libgmock-dev libbenchmark-dev
  nlohmann-json3-dev libpugixml-dev libcsv-dev libvtk9-dev libgmsh-dev
  petsc-dev pkg-config
  help2man pybind11-dev python3-dev python3-numpy python3-matplotlib python3-setuptools python3-pytest python3-pip mypy
)

# The page of `elastimate report` is bundled by npm, of Debian or another one.
command -v npm >/dev/null || packages+=(nodejs npm)

missing=()
for package in "${packages[@]}"; do
  if [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)" != installed ]; then
    missing+=("$package")
  fi
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  as_root=(sudo)
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "Installing ${missing[*]}"
if ! { "${as_root[@]}" apt-get update -qq &&
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
  cat "$log" >&2
  echo "The packages could not be installed; see above." >&2
  exit 1
fi
