#!/bin/sh
# Opens a baked Cornell box in Blender, headless, and compares 50 colours with the table.
# Usage: blender.sh PARALLUX SCENE. Exit code 77: Blender is not installed, nothing was tested.
set -eu
here=$(dirname "$0")
if ! command -v blender > /dev/null; then
    echo "skipped: blender is not installed (apt-get install blender)"
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" solve "$2" --patches 2000 --bundles 256 --quiet --flat --bake-mesh patches --unlit \
    --bake "$work/bake.glb" --table "$work/table.csv"
blender --background --python-exit-code 1 --python "$here/blender.py" -- \
    "$work/bake.glb" "$work/table.csv"
