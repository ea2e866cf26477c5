#!/usr/bin/env bash
# odd.sh PROGRAM SCENES [all]: memory that is not there, stops, a slow disk, a folder that is gone,
# a locale with decimal commas, two runs on one output.
# Planted, each seen to fail: a second signal that waits for the disk; the locale of the environment
# taken up; numbers of a table by std::to_string in that locale; exceptions out of libraries' noexcept
# functions left to std::terminate (allocation 4859 of 11 559, code 134), every failure of Embree's to
# start an internal one (10 040, code 70). Of all 11 559, once, 8914 and 8915 ended with code 70 as
# well: Embree could not keep its error; 7586 left an empty temporary, which an OutputFile had made
# and not yet named.
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
make_reference

# Memory: allocations that fail one at a time, then limits below the need.
if [[ -e $preload ]]; then
    LD_PRELOAD=$preload FAULT_COUNT=1 "$program" solve "$scene" "${small[@]}" --quiet \
        "${outputs[@]}" 2>err
    allocations=$(tail -1 err)
    check "allocations are counted" test "$allocations" -gt 1000
    [[ ${3-} == all ]] && tries=2000 || tries=60
    for ((k = 0; k < tries; k++)); do
        n=$((1 + (k * 7919 + k * k * 104729) % allocations))
        restore_old
        LD_PRELOAD=$preload FAULT_NEW=$n "$program" solve "$scene" "${small[@]}" --quiet \
            "${outputs[@]}" >out 2>err
        code=$?
        check "allocation $n of $allocations fails: code" is_code "5 0"
        ((code == 5)) && check "allocation $n fails: one line" one_line
        for file in "${files[@]}"; do check "allocation $n fails: $file" old_or_new "$file"; done
    done
    check "nothing was left by failing allocations" no_temporaries
fi
for kib in 60000 150000 250000; do
    restore_old
    (ulimit -v $kib; exec "$program" solve "$scene" --patches 3000000 --bundles 1000 --threads 1 \
        --table t.csv >out 2>err)
    code=$?
    # Below what the system needs to load the program, it says so itself.
    check "$kib KiB of addresses: code" is_code "5 127"
    check "$kib KiB of addresses: the table" cmp -s t.csv old
done
solve --patches 3000000 --max-memory 200M --table t.csv
check "too little allowed: code" is_code 5
check "too little allowed: one line" one_line

# Stopped and continued, three times.
long=(--patches 400 --bundles 20000 --first-shot rays --threads 2 --quiet)
solve "${long[@]}" --stats whole.json
"$program" solve "$scene" "${long[@]}" --checkpoint c.plx --checkpoint-every 0.05 --stats s.json \
    2>err &
run=$!
for k in 1 2 3; do
    sleep 0.1
    kill -STOP $run 2>/dev/null
    sleep 0.3
    kill -CONT $run 2>/dev/null
done
wait $run
code=$?
check "stopped and continued: code" is_code 0
check "stopped and continued: the same bits" test "$(hash_of s.json)" == "$(hash_of whole.json)"

# Where the disk is slow, a second signal does not wait for it, and leaves nothing.
if [[ -e $preload ]]; then
    rm -f c.plx
    LD_PRELOAD=$preload FAULT_FSYNC=20 "$program" solve "$scene" --patches 60 --bundles 10000000 \
        --threads 1 --checkpoint c.plx --checkpoint-every 0.01 --progress off >out 2>err &
    run=$!
    for ((k = 0; k < 400; k++)); do
        compgen -G ".c.*.plx" >/dev/null && break
        sleep 0.05
    done
    sleep 0.3
    start=$(date +%s%N)
    kill -TERM $run
    sleep 0.2
    kill -TERM $run
    wait $run
    code=$?
    took=$((($(date +%s%N) - start) / 1000000))
    check "two signals and a slow disk: code" is_code 130
    check "two signals and a slow disk: $took ms" test $took -lt 1200
    check "two signals and a slow disk: nothing was left" no_temporaries
fi

# The working folder is gone.
mkdir gone
(cd gone && rmdir ../gone && "$program" solve "$scene" "${small[@]}" --quiet --table "$work/t.csv" \
    2>"$work/err")
code=$?
check "no working folder: code" is_code 0
check "no working folder: the table" cmp -s t.csv ref/t.csv
mkdir gone
(cd gone && rmdir ../gone && "$program" solve "$scene" "${small[@]}" --table t.csv 2>"$work/err")
code=$?
check "a file in no working folder: code" is_code 4
check "a file in no working folder: one line" one_line

# Decimal commas.
if localedef -i de_DE -f UTF-8 "$work/de_DE.UTF-8" 2>/dev/null; then
    export LOCPATH=$work LC_ALL=de_DE.UTF-8
    check "the locale has commas" test "$(bash -c 'printf %.1f 1,5')" == 1,5
    solve --patches 60 --bundles 64 --threads 1 --quiet "${outputs[@]}" --time-limit 1000.5
    check "commas: code" is_code 0
    for file in "${files[@]}"; do check "commas: $file" is_new "$file"; done
    "$program" compare t.csv ref/t.csv --tolerance 1e-9 >out
    code=$?
    check "commas: tables are equal" is_code 0
    unset LOCPATH LC_ALL
else
    echo "no locale with commas can be made here: left out"
fi

# Two runs on one output, and on one checkpoint.
for k in 1 2 3 4 5; do
    "$program" solve "$scene" "${small[@]}" --quiet --table t.csv --checkpoint c.plx \
        --checkpoint-every 0.000001 2>err.1 &
    "$program" solve "$scene" "${small[@]}" --seed 2 --quiet --table t.csv --checkpoint c.plx \
        --checkpoint-every 0.000001 2>err
    code=$?
    wait $!
    check "two runs: the first" test $? == 0
    check "two runs: the second" is_code 0
    [[ -e other.csv ]] || solve "${small[@]}" --seed 2 --quiet --table other.csv
    check "two runs: one of the tables" eval 'cmp -s t.csv ref/t.csv || cmp -s t.csv other.csv'
    solve "${small[@]}" --quiet --resume c.plx
    mine=$code
    solve "${small[@]}" --seed 2 --quiet --resume c.plx
    check "two runs: one of the checkpoints" test $((mine + code)) == 3
done
summary
