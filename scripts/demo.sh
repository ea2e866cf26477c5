#!/usr/bin/env bash
# Builds the program and solves the Cornell box: out/cornell_box.png and out/cornell_box.json.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install-deps.sh
cmake --preset release
cmake --build --preset release --target parallux_program
mkdir -p out
build/release/parallux solve scenes/cornell_box.gltf --patches 20000 \
    --image out/cornell_box.png --stats out/cornell_box.json

echo
echo "Picture     $PWD/out/cornell_box.png"
echo "Statistics  $PWD/out/cornell_box.json"
