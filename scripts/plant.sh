#!/usr/bin/env bash
# Plants errors in a copy of the tree, one at a time: each patch of tests/planted names the test that
# must then fail. scripts/plant.sh [PATCH …] plants all of them or those named; with --check it only
# makes sure that all can still be applied.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [[ ${1-} == --check ]]; then
    status=0
    for planted in tests/planted/*.patch; do
        if ! patch -p1 --dry-run --batch --silent <"$planted" >/dev/null; then
            echo "plant.sh: $planted can no longer be applied; plant its error anew" >&2
            status=1
        fi
    done
    exit $status
fi

patches=("$@")
((${#patches[@]} > 0)) || patches=(tests/planted/*.patch)
copy=build/planted
[[ -e $copy/clean ]] || rm -rf "$copy" # an earlier run was broken off, and an error may be in there
mkdir -p "$copy"
rm -f "$copy/clean"
tar -cf - --exclude=./build --exclude=./out --exclude=./.git . | tar -xf - -C "$copy"
cmake -S "$copy" -B "$copy/build/release" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DPARALLUX_BUILD_BENCH=OFF >/dev/null

# The test's exit code; what it prints goes to a log.
run_test() { # program, case, log
    cmake --build "$copy/build/release" --target "$1" >"$3" 2>&1 ||
        { echo "plant.sh: $1 does not build; see $3" >&2 && exit 1; }
    # An error may also keep a test from ending.
    timeout 600 "$copy/build/release/tests/$1" --test-case="$2" >>"$3" 2>&1
}

status=0
for planted in "${patches[@]}"; do
    name=$(basename "$planted" .patch)
    program=$(sed -n 's/^Test: //p' "$planted")
    cases=$(sed -n 's/^Case: //p' "$planted")
    log=$copy/$name.log
    # A case that does not pass without the error would prove nothing.
    if ! run_test "$program" "$cases" "$log" || grep -q 'test cases: *0 ' "$log"; then
        echo "$name: $program \"$cases\" does not pass without the error" >&2
        status=1
        continue
    fi
    patch -p1 --batch --silent -d "$copy" <"$planted"
    if run_test "$program" "$cases" "$log"; then
        echo "$name: NOT FOUND by $program \"$cases\"" >&2
        status=1
    else
        echo "$name: found by $program \"$cases\""
    fi
    patch -p1 -R --batch --silent -d "$copy" <"$planted"
    cmake --build "$copy/build/release" --target "$program" >/dev/null
done
touch "$copy/clean"
exit $status
