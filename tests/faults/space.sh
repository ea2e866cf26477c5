#!/usr/bin/env bash
# space.sh PROGRAM SCENES: disks that are full, limits, and targets that cannot be written: code 4
# and one line, the older file whole, no temporary left.
# Planted, each seen to fail: a target that is no file replaced; SIGXFSZ left to the system.
. "$(dirname "${BASH_SOURCE[0]}")/lib.sh"
make_reference

# Refused before the solve: what is no file, or in no folder.
refused() {
    solve "${small[@]}" "$@"
    check "$*: code" is_code 4
    check "$*: one line" one_line
}
mkfifo fifo
mkdir folder
refused --table fifo
check "the pipe is still one" test -p fifo
refused --table folder
refused --table absent/t.csv
refused --checkpoint folder
refused --checkpoint absent/c.plx
refused --table old/t.csv
if ((EUID == 0)) && mknod device c 1 7 2>/dev/null; then
    refused --stats device
    refused --checkpoint device
    check "the device is still one" test -c device
fi
ln -s device link
[[ -c device ]] && refused --table link
check "nothing was left by all these" no_temporaries

# Standard output.
"$program" solve "$scene" "${small[@]}" >/dev/full 2>err
code=$?
check "/dev/full: code" is_code 4
"$program" solve "$scene" "${small[@]}" --table t.csv >&- 2>err
code=$?
check "no standard output: code" is_code 4
check "no standard output: the table" cmp -s t.csv ref/t.csv
"$program" solve "$scene" "${small[@]}" --table t.csv >out 2>&-
code=$?
check "no standard error: code" is_code 0
"$program" solve "$scene" "${small[@]}" --table t.csv --quiet >&- 2>&- <&-
code=$?
check "no stream at all: code" is_code 0
check "no stream at all: the table" cmp -s t.csv ref/t.csv
"$program" solve "$scene" "${small[@]}" --table t.csv >out 2>/dev/full
code=$?
check "standard error to a full disk: code" is_code 0

# A limit on files, below what each output takes.
for limit in 0 1 2; do
    restore_old
    (ulimit -f $limit; "$program" solve "$scene" "${small[@]}" --quiet --table t.csv --save r.plx 2>err)
    code=$?
    check "files up to $limit KiB: code" is_code 4
    check "files up to $limit KiB: the table" cmp -s t.csv old
    check "files up to $limit KiB: the result" old_or_new r.plx
done
(ulimit -f 0; "$program" solve "$scene" "${small[@]}" --quiet --checkpoint c.plx \
    --time-limit 0.000001 2>err)
code=$?
check "a checkpoint beyond the limit: code" is_code 4
check "a checkpoint beyond the limit: none" test ! -e c.plx
check "nothing was left by limits" no_temporaries

# A disk that is really full, and one that may not be written.
mkdir disk
if ((EUID != 0)) || ! mount -t tmpfs -o size=32k tmpfs disk 2>/dev/null; then
    echo "no small disk can be mounted here: left out"
    summary
fi
trap 'cd /; umount "$work/disk"; rm -rf "$work"' EXIT
cp old disk/t.csv
cp old disk/r.plx
head -c 100000 /dev/zero >disk/filler 2>/dev/null
for output in "--table disk/t.csv" "--save disk/r.plx" "--image disk/i.png"; do
    solve "${small[@]}" --quiet $output
    check "full disk, $output: code" is_code 4
    check "full disk, $output: one line" one_line
done
check "full disk: the table" cmp -s disk/t.csv old
check "full disk: the result" cmp -s disk/r.plx old
solve "${small[@]}" --quiet --checkpoint disk/c.plx --checkpoint-every 0.000001 --table t.csv
check "full disk: a checkpoint ends no run" is_code 0
check "full disk: the same bits" cmp -s t.csv ref/t.csv
check "full disk: nothing was left" no_temporaries disk
rm disk/filler
solve "${small[@]}" --quiet --table disk/t.csv
check "room again: code" is_code 0
mount -o remount,ro disk
solve "${small[@]}" --quiet --table disk/t.csv
check "read-only: code" is_code 4
check "read-only: one line" one_line
summary
