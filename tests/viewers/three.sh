#!/bin/sh
# Opens a baked Cornell box in three.js, in headless Chromium, and compares 50 colours with the table,
# as loaded and as drawn.
# Planted, each seen to fail: the exposure stated without the power of two in it; colours as sRGB.
# Usage: three.sh PARALLUX SCENE [SCREENSHOT.png]. Needs node, chromium (or its path in CHROMIUM) and the
# npm packages three and puppeteer-core where NODE_PATH says; gltf-validator, if there, is asked as
# well. Exit code 77: something is not installed, nothing was tested.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
skip() {
    echo "skipped: $1"
    exit 77
}
CHROMIUM=${CHROMIUM:-$(command -v chromium || true)}
[ -n "$CHROMIUM" ] || skip "chromium is not installed (apt-get install chromium)"
command -v node > /dev/null || skip "node is not installed (apt-get install nodejs)"
node -e 'require.resolve("three"); require.resolve("puppeteer-core")' 2> /dev/null ||
    skip "three and puppeteer-core are not found (npm install --prefix DIR three puppeteer-core; NODE_PATH=DIR/node_modules)"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" solve "$2" --patches 2000 --bundles 256 --quiet --save "$work/result.plx" --table "$work/table.csv"
"$1" bake "$work/result.plx" "$2" --quiet --flat --bake-mesh patches --unlit --bake "$work/unlit.glb"
"$1" bake "$work/result.plx" "$2" --quiet --flat --bake-mesh patches --bake "$work/bake.glb"
"$1" bake "$work/result.plx" "$2" --quiet --lightmap "$work/map.exr"
export CHROMIUM
node "$here/three.cjs" "$work" "$2" "${3:-$work/three.png}"
