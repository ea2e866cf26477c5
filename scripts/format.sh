#!/usr/bin/env bash
# Formats all sources; with --check only says what is not formatted, and fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

action=(-i)
if [[ ${1-} == --check ]]; then
    action=(-n -Werror)
elif (($# > 0)); then
    echo "usage: scripts/format.sh [--check]" >&2
    exit 2
fi
find include src tests bench -type f '(' -name '*.h' -o -name '*.cpp' ')' -print0 |
    xargs -0 clang-format "${action[@]}"
