#!/usr/bin/env bash
# Installs the Debian packages that building, testing and checking need: only those that are
# missing, so that a second run changes nothing.
set -euo pipefail

packages=(
    g++ cmake ninja-build
    libtbb-dev libembree-dev libopenimageio-dev openimageio-tools libglm-dev
    nlohmann-json3-dev libcli11-dev libeigen3-dev libhwy-dev
    doctest-dev libbenchmark-dev gnuplot-nox
    clang-format clang-14 libclang-rt-14-dev llvm-14 valgrind patch strace
)

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $status == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
    exit 0
fi

as_root=()
if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
        echo "install-deps.sh: run as root or with sudo: apt-get install ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi
echo "Installing ${missing[*]}"
"${as_root[@]}" apt-get update
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}"
