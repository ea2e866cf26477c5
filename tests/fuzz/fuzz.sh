#!/usr/bin/env bash
# Fuzzes targets: tests/fuzz/fuzz.sh SECONDS [TARGET …], all of them when none is named, as many at
# once as there are processors. Each begins with the corpus in the repository and keeps what is new
# in build/PRESET/found; a find ends with exit code 1 and leaves the input there. Says how many inputs
# were run. With RUNS in place of SECONDS (1000000r) each ends after so many inputs. PRESET=fuzz-quick
# goes without sanitizers, several times faster; SEED=N begins with the same inputs every time.
# An input that takes minutes is a find; seconds are what a busy machine makes of tenths.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

limit=${1:?usage: tests/fuzz/fuzz.sh SECONDS|RUNSr [TARGET …]}
shift
targets=("$@")
((${#targets[@]} > 0)) || mapfile -t targets < <(ls tests/fuzz/corpus)

export PRESET=${PRESET:-fuzz}
cmake --preset "$PRESET" >/dev/null
cmake --build --preset "$PRESET" >/dev/null
if [[ $limit == *r ]]; then
    export LIMIT=-runs=${limit%r}
else
    export LIMIT=-max_total_time=$limit
fi

fuzz_one() { # target
    local found=build/$PRESET/found target=$1 status=0
    local log=$found/$target.log words=()
    mkdir -p "$found/$target"
    [[ -f tests/fuzz/words/$target ]] && words=("-dict=tests/fuzz/words/$target")
    nice -n 19 "build/$PRESET/tests/fuzz/fuzz_$target" "${words[@]}" "$LIMIT" -seed="${SEED:-0}" \
        -timeout=300 -rss_limit_mb=2048 -malloc_limit_mb=1024 -max_len=4096 -print_final_stats=1 \
        -artifact_prefix="$found/$target-" "$found/$target" "tests/fuzz/corpus/$target" \
        >"$log" 2>&1 || status=1
    echo "$target $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") runs"
    if ((status != 0)); then
        echo "fuzz: $target has a find; see $log, which ends:" >&2
        grep -E '^(==[0-9]+==|SUMMARY|fuzz:|artifact_prefix|Base64)' "$log" >&2
    fi
    return $status
}
export -f fuzz_one
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I '{}' bash -c 'fuzz_one {}'
