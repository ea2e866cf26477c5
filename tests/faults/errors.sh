#!/usr/bin/env bash
# errors.sh PROGRAM SCENES [all]: EIO, ENOSPC and EDQUOT at every write, fsync, close and rename of
# the output path (one of the three at each; with `all` each). Code 4 and one line, every file old or
# new and whole, no temporary left; a checkpoint that fails ends no run.
# Planted, each seen to fail: fsync's, close's, rename's answer not looked at; the temporary left.
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
can_trace || skip "strace cannot trace here"
make_reference
errors=(EIO ENOSPC EDQUOT)
[[ ${3-} == all ]] && every=3 || every=1
calls=(write fsync close rename)
count_calls "${small[@]}" --quiet "${outputs[@]}"
failed=0 unheard=0 n=0
for call in "${calls[@]}"; do
    for ((k = before[$call] + 1; k <= all[$call]; k++)); do
        for ((e = 0; e < every; e++)); do
            error=${errors[(k + e) % 3]}
            restore_old
            tracer=(strace -f -o /dev/null -e "trace=$call" -e "inject=$call:error=$error:when=$k")
            solve "${small[@]}" --quiet "${outputs[@]}"
            what="$error at $call $k"
            check "$what: code" is_code "4 0"
            for file in "${files[@]}"; do check "$what: $file" old_or_new "$file"; done
            if ((code == 4)); then
                failed=$((failed + 1))
                check "$what: one line" one_line
                check "$what: the line names a file" grep -q "t.csv\|s.json\|r.plx\|i.png" err
            else
                # Only what is no harm may go unheard: the close of a folder, or of an input.
                unheard=$((unheard + 1))
                check "$what: unheard" test "$call" == close
                for file in "${files[@]}"; do check "$what: $file is new" is_new "$file"; done
            fi
            check "$what: no temporary" no_temporaries
            rm -f .??*.??????*
        done
    done
done
echo "$failed failed as they should, $unheard did no harm"
check "many failed" test $failed -ge 20

# The checkpoint of a run that was stopped, and of one that goes on.
tracer=()
solve "${small[@]}" --quiet --stats s.json
hash=$(hash_of s.json)
for call in write fsync rename; do
    tracer=(strace -f -o /dev/null -e "trace=$call" -e "inject=$call:error=ENOSPC:when=1+")
    cp old c.plx
    solve "${small[@]}" --quiet --checkpoint c.plx --time-limit 0.000001
    check "$call of a last checkpoint: code" is_code 4
    check "$call of a last checkpoint: the older file" cmp -s c.plx old
    check "$call of a last checkpoint: no temporary" no_temporaries
done
tracer=(strace -f -o /dev/null -e trace=fsync -e inject=fsync:error=ENOSPC:when=1..2)
solve "${small[@]}" --checkpoint c.plx --checkpoint-every 0.000001 --progress off
check "a checkpoint on the way: code" is_code 0
check "a checkpoint on the way: told" grep -q "warning: c.plx: cannot write" err

summary
