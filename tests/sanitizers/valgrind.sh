#!/usr/bin/env bash
# Small solves and bakes under valgrind, which also sees what is used before it is set, in every line
# of every library: tests/sanitizers/valgrind.sh, with the programs in build/release. Fails unless an
# error that is made on purpose is found, and nothing else.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
under() { valgrind --quiet --error-exitcode=9 --suppressions=tests/sanitizers/valgrind.supp "$@"; }

code=0
under build/release/tests/sanitizers/sanitizer_errors overrun >"$work/out" 2>"$work/err" || code=$?
if ((code != 9)); then
    echo "valgrind.sh: the planted overrun was not found" >&2
    status=1
else
    echo "planted overrun found"
fi
try() {
    if under build/release/parallux "$@" --quiet >"$work/out" 2>"$work/err"; then
        echo "passed: parallux $*"
    else
        echo "valgrind.sh: parallux $* fails:" >&2
        cat "$work/err" >&2
        status=1
    fi
}
try solve scenes/cornell_box.gltf --patches 60 --bundles 32 --threads 2 --image "$work/a.png" \
    --size 32x32 --table "$work/a.csv" --bake "$work/a.glb" --save "$work/a.plx"
try solve scenes/cornell_box.gltf --patches 60 --bundles 16 --threads 1 --first-shot rays
try solve scenes/furnace.json --patches 60 --bundles 16 --method lines --threads 1
try solve scenes/curved_room.json --patches 400 --bundles 8 --threads 2 --image "$work/c.png" \
    --size 24x18 --samples 2
try bake "$work/a.plx" scenes/cornell_box.gltf --lightmap "$work/m.exr"
try factors scenes/cornell_box.gltf --bundles 16 -o "$work/f.mtx"
exit $status
