#!/usr/bin/env bash
# Memory told before a run against what it took: tests/memory/peaks.sh PATCHES …, with the program
# in build/release or $PARALLUX. Fails unless every peak is 70 to 100 % of what was told, unless
# --max-memory just below that is refused within a second, and just above it is honoured.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

program=${PARALLUX:-build/release/parallux}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
status=0

# The number behind a key of the statistics.
value() { sed -n "s/^  \"$1\": \([0-9]*\),$/\1/p" "$folder/s.json"; }

check() { # scene, patches, settings …
    local scene=$1 patches=$2
    shift 2
    local run=("$program" solve "scenes/$scene" --patches "$patches" --threads 2 --quiet "$@")
    "${run[@]}" --stats "$folder/s.json"
    local told peak share
    told=$(value predicted_memory_bytes) peak=$(value peak_memory_bytes)
    share=$((100 * peak / told))
    echo "$scene $(value patches) patches, peak $((peak >> 20)) MiB, $share % of what was told: $*"
    if ((share < 70 || peak > told)); then
        echo "peaks.sh: not within 70 to 100 %" >&2
        status=1
    fi
}

refused() { # scene, patches: what is told for one bank, so a little less than that
    local run=("$program" solve "scenes/$1" --patches "$2" --threads 2 --quiet --bundles 16)
    local code=0
    # Reading the scene and dividing it come before.
    timeout $((2 + $2 / 500000)) "${run[@]}" --max-memory 50M 2>"$folder/told" || code=$?
    if ((code != 5)) || ! grep -q "MiB allowed" "$folder/told"; then
        echo "peaks.sh: $1 with $2 patches is not refused in time: code $code" >&2
        status=1
    fi
}

for patches in "$@"; do
    bundles=(--bundles 64)
    ((patches > 100000)) && bundles=(--bundles 16)
    check furnace.json "$patches" "${bundles[@]}" --first-shot none
    check furnace.json "$patches" "${bundles[@]}" --first-shot rays --groups 4
    check cornell_box.gltf "$patches" "${bundles[@]}" --first-shot none
    check cornell_box.gltf "$patches" "${bundles[@]}" --first-shot rays
    check cornell_box.gltf "$patches" "${bundles[@]}" --groups 4
    if ((patches <= 1000000)); then
        check cornell_box.gltf "$patches" "${bundles[@]}" --first-shot exact
    fi
    refused cornell_box.gltf "$patches"
done
exit $status
