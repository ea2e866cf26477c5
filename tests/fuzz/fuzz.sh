#!/usr/bin/env bash
# Fuzzes targets: tests/fuzz/fuzz.sh SECONDS [TARGET …], all of them when none is named. Starts from
# the corpus in the repository and keeps what is new in build/fuzz/found; a find ends with exit
# code 1 and leaves the input there. Says how many inputs were run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

seconds=${1:?usage: tests/fuzz/fuzz.sh SECONDS [TARGET …]}
shift
targets=("$@")
((${#targets[@]} > 0)) || mapfile -t targets < <(ls tests/fuzz/corpus)

cmake --preset fuzz >/dev/null
cmake --build --preset fuzz >/dev/null
found=build/fuzz/found
status=0
for target in "${targets[@]}"; do
    mkdir -p "$found/$target"
    words=()
    [[ -f tests/fuzz/words/$target ]] && words=("-dict=tests/fuzz/words/$target")
    log=$found/$target.log
    if ! nice -n 19 "build/fuzz/tests/fuzz/fuzz_$target" "${words[@]}" -max_total_time="$seconds" \
        -timeout=20 -rss_limit_mb=2048 -malloc_limit_mb=1024 -max_len=4096 -print_final_stats=1 \
        -artifact_prefix="$found/$target-" "$found/$target" "tests/fuzz/corpus/$target" \
        >"$log" 2>&1; then
        echo "fuzz: $target has a find; see $log" >&2
        status=1
    fi
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    echo "$target ${runs:-?} runs"
done
exit $status
