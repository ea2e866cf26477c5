# What the fault tests share. Sourced with the program and the scenes' folder as arguments; gives a
# folder that is gone afterwards, a scene whose solve takes a few hundredths of a second, and checks.
set -uo pipefail

program=$1
scenes=$2
preload=$(dirname "$program")/tests/libfaults.so
work=$(mktemp -d)
cd "$work"
failures=0
checks=0
scene=$scenes/cornell_box.gltf
small=(--patches 60 --bundles 64 --threads 1)
trap 'cd /; rm -rf "$work"' EXIT

# check WHAT CONDITION...: counts, and tells what does not hold.
check() {
    local what=$1
    shift
    checks=$((checks + 1))
    "$@" && return
    failures=$((failures + 1))
    echo "FAILED: $what: $*"
    [[ -s err ]] && sed 's/^/    stderr: /' err
    return 0
}

# What ends the script.
summary() {
    echo "$checks checks, $failures failed"
    ((checks > 0 && failures == 0))
    exit
}

skip() {
    echo "skipped: $1"
    exit 77
}

can_trace() {
    command -v strace >/dev/null && strace -f -o /dev/null true 2>/dev/null
}

# solve ARGUMENTS...: exit code in $code, standard error in err, under the tracer in $tracer.
tracer=()
solve() {
    "${tracer[@]}" "$program" solve "$scene" "$@" >out 2>err
    code=$?
}

hash_of() {
    sed -n 's/.*"solution_hash": *"\([0-9a-fx]*\)".*/\1/p' "$1"
}

one_line() {
    [[ $(wc -l <err) == 1 ]] && grep -q "^parallux: " err
}

no_temporaries() {
    ! compgen -G "${1:-.}/.*.??????*" >/dev/null
}

is_code() {
    [[ " $1 " == *" $code "* ]]
}

# The output is what it was, or the whole of what it should become.
old_or_new() {
    cmp -s "$1" old && return
    case $1 in
        *.json) [[ $(hash_of "$1") == "$(hash_of ref/s.json)" && $(tail -c 2 "$1") == "}" ]] ;;
        *.plx) "$program" render "$1" "$scene" --table again.csv >/dev/null 2>&1 &&
            cmp -s again.csv ref/t.csv ;;
        *) cmp -s "$1" "ref/${1##*/}" ;;
    esac
}
is_new() {
    ! cmp -s "$1" old && old_or_new "$1"
}

outputs=(--table t.csv --stats s.json --save r.plx --image i.png --size 16x16 --samples 1)
files=(t.csv s.json r.plx i.png)

# The outputs as they should be, below ref; and something old in the place of each.
make_reference() {
    mkdir -p ref
    (cd ref && "$program" solve "$scene" "${small[@]}" --quiet "${outputs[@]}" >/dev/null) ||
        { echo "FAILED: no reference"; exit 1; }
    echo "something old" >old
}
restore_old() {
    local file
    for file in "${files[@]}"; do cp old "$file"; done
}

# Where in a trace the output begins and ends: for each system call in $calls, how many of it the
# program's first thread makes before its first temporary, and in all.
calls=(write fsync close rename fchmod)
count_calls() {
    strace -f -o trace -e trace=openat,write,fsync,close,rename,fchmod "$program" solve "$scene" \
        "$@" >/dev/null 2>err || { echo "FAILED: no trace"; cat err; exit 1; }
    local first=${FIRST_THREAD-$(head -1 trace | cut -d' ' -f1)} begin call
    begin=$(grep -n O_EXCL trace | head -1 | cut -d: -f1)
    for call in "${calls[@]}"; do
        before[$call]=$(head -"$begin" trace | grep -c "^$first *$call(")
        all[$call]=$(grep -c "^$first *$call(" trace)
    done
}
declare -A before all
