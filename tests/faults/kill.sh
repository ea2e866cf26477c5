#!/usr/bin/env bash
# kill.sh PROGRAM SCENES [all]: SIGKILL at random moments, and at every system call of the output
# path. The files are old or new, whole; a killed run is taken up again to the same bits.
# Planted, each seen to fail: temporary and target swapped (the target written in place); a
# checkpoint renamed before it is written; checkpoints that are never written (no progress).
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"

# The share of a run that a checkpoint has done; all of it where nothing is left to tell of. Run
# here, so that its check counts: the answer is in `share`.
done_in() {
    solve "${long[@]}" --resume "$1" --time-limit 0.001 --progress json
    check "taken up to tell how far it is" is_code 0
    share=$(sed -n 's/.*"done":\([0-9.e-]*\).*/\1/p' err | head -1)
    share=${share:-1}
}

# One run of some seconds, killed at 40 random moments, each time resumed from what the last one
# kept; every second time only once something new was kept.
RANDOM=1
long=(--patches 400 --bundles 100000 --first-shot rays --quiet)
solve "${long[@]}" --threads 2 --stats whole.json
check "the whole run" is_code 0
echo "something old" >old
cp old t.csv
for k in {1..40}; do
    from=()
    [[ -e c.plx ]] && from=(--resume c.plx)
    touch begun
    "$program" solve "$scene" "${long[@]}" --threads $((1 + k % 3)) --table t.csv "${from[@]}" \
        --checkpoint c.plx --checkpoint-every 0.05 >out 2>err &
    run=$!
    while ((k % 2)) && [[ ! c.plx -nt begun ]] && kill -0 $run 2>/dev/null; do sleep 0.02; done
    sleep 0.$((10 + RANDOM % 30))
    kill -KILL $run 2>/dev/null
    wait $run 2>/dev/null
    code=$?
    check "kill $k: killed or done" is_code "137 0"
    ((k == 1)) && cp c.plx first.plx
    ((code == 0)) && break
    check "kill $k: the table is the old one" cmp -s t.csv old
done
echo "ended at kill $k with code $code"
check "every kill but a few came in time" test $k -gt 4
solve "${long[@]}" --threads 2 --resume c.plx --stats s.json
check "resumed after all" is_code 0
check "the same bits" test "$(hash_of s.json)" == "$(hash_of whole.json)"
done_in first.plx && begun=$share
done_in c.plx
echo "$begun $share" >shares
check "what was kept grew: $(<shares)" awk '{ exit !($2 > $1 && $1 > 0) }' shares
rm -f c.plx .c.*  # a killed run may leave a temporary, which is in nobody's way

can_trace || { echo "no strace: system calls left out"; summary; }
make_reference
kept=(--checkpoint c.plx --time-limit 0.000001)
count_calls "${small[@]}" --quiet "${outputs[@]}"
kills=0
for call in "${calls[@]}"; do
    for ((n = before[$call] + 1; n <= all[$call]; n++)); do
        restore_old
        tracer=(strace -f -o /dev/null -e "trace=$call" -e "inject=$call:signal=KILL:when=$n")
        solve "${small[@]}" --quiet "${outputs[@]}"
        kills=$((kills + 1))
        check "killed at $call $n" is_code 137
        for file in "${files[@]}"; do check "killed at $call $n: $file" old_or_new "$file"; done
    done
done
# And the checkpoint's thread, which has counts of its own.
tracer=()
solve "${small[@]}" --quiet --stats s.json
hash=$(hash_of s.json)
solve "${small[@]}" --quiet "${kept[@]}"
check "stopped and kept" is_code 0
cp c.plx older.plx
for call in "${calls[@]}"; do
    for n in 1 2 3; do
        cp older.plx c.plx
        # How many it makes: none is made by another thread but that of checkpoints.
        tracer=(strace -f -o trace -e "trace=$call")
        solve "${small[@]}" --quiet "${kept[@]}"
        first=$(head -1 trace | cut -d' ' -f1)
        others=$(grep -v "^$first " trace | grep -c " $call(")
        ((n > others)) && break
        tracer=(strace -f -o /dev/null -e "trace=$call" -e "inject=$call:signal=KILL:when=$n")
        solve "${small[@]}" --quiet "${kept[@]}"
        kills=$((kills + 1))
        tracer=()
        solve "${small[@]}" --quiet --resume c.plx --stats s.json
        check "killed at $call $n of a checkpoint: resumed" is_code 0
        check "killed at $call $n of a checkpoint: the same bits" test "$(hash_of s.json)" == "$hash"
    done
done
rm -f .??*.??????*
solve "${small[@]}" --quiet "${outputs[@]}"
check "the next run works" is_code 0
echo "$kills system calls"
check "enough of them" test $kills -gt 20
summary
