#!/usr/bin/env bash
# All that takes too long for every change; about three hours on two cores. What came of each part
# goes to tests/soak-results.md. scripts/soak.sh [PART …], of: plant fuzz asan threads valgrind memory
# faults
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

logs=build/soak
mkdir -p "$logs"
status=0

# Runs a part, keeps what it prints, and notes whether it was well and how long it took.
part() { # name, command …
    local name=$1 begin=$SECONDS outcome=passed
    shift
    echo "soak: $name"
    "$@" >"$logs/$name.log" 2>&1 || { outcome=FAILED && status=1; }
    echo "soak: $name $outcome"
    {
        echo "$outcome in $((SECONDS - begin)) s, $(date -u +%F), commit $(git describe --always --dirty 2>/dev/null)"
        echo
        grep -hE "^  ? ? ?[a-z_]+ [0-9]+ runs|found by|NOT FOUND|tests passed|tests failed|patches, peak|planted|checks, [0-9]+ failed" \
            "$logs/$name.log" | sed 's/^ */    /'
    } >"$logs/$name.md"
}

# A sanitizer's suite, which also makes errors that it must find.
sanitized() { # preset
    cmake --preset "$1" && cmake --build --preset "$1" && ctest --preset "$1"
}

# Every error at every system call, two thousand failing allocations, hundreds of random moments.
faults() {
    cmake --preset release && cmake --build --preset release || return
    local fault code round
    for fault in kill errors space odd; do
        code=0
        tests/faults/$fault.sh "$PWD/build/release/parallux" "$PWD/scenes" all || code=$?
        ((code == 0 || code == 77)) || return $code
    done
    for round in 1 2 3 4 5; do
        PARALLUX_SOAK=$round build/release/tests/test_checkpoints || return
        PARALLUX_SOAK=$round build/release/tests/test_cli -sf='*checkpoints.cpp,*signals.cpp' || return
    done
}

parts=("$@")
((${#parts[@]} > 0)) || parts=(plant fuzz asan threads valgrind memory faults)
scripts/install-deps.sh || exit 1
for name in "${parts[@]}"; do
    case $name in
        plant) part plant scripts/plant.sh ;;
        fuzz) part fuzz tests/fuzz/fuzz.sh 60 ;;
        asan) part asan sanitized asan-ubsan ;;
        threads) part threads sanitized threads-check ;;
        valgrind) part valgrind tests/sanitizers/valgrind.sh ;;
        memory) part memory tests/memory/peaks.sh 1000 10000 100000 1000000 10000000 ;;
        faults) part faults faults ;;
        *) echo "soak.sh: no part $name" >&2 && exit 2 ;;
    esac
done

{
    echo "# What scripts/soak.sh found last"
    for name in plant fuzz asan threads valgrind memory faults; do
        [[ -f $logs/$name.md ]] || continue
        echo
        echo "## $name"
        echo
        cat "$logs/$name.md"
    done
} >tests/soak-results.md
exit $status
