#!/usr/bin/env bash
# soak.sh [ROUNDS]: the tests of faults and interruptions, longer than ctest has time for: every
# error at every system call, two thousand failing allocations, hundreds of random moments.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

rounds=${1:-5}
scripts/install-deps.sh
cmake --preset release
cmake --build --preset release
for fault in kill errors space odd; do
    echo "== $fault"
    code=0
    tests/faults/$fault.sh "$PWD/build/release/parallux" "$PWD/scenes" all || code=$?
    ((code == 0 || code == 77))
done
for ((round = 1; round <= rounds; round++)); do
    echo "== round $round of $rounds"
    PARALLUX_SOAK=$round build/release/tests/test_checkpoints
    PARALLUX_SOAK=$round build/release/tests/test_cli -sf='*checkpoints.cpp,*signals.cpp'
done
