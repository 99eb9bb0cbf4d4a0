#!/usr/bin/env bash
# Runs the extremes, the same table the tests judge, and writes docs/stability.md.
#
#   scripts/stability.sh
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

scripts/setup.sh
cmake --preset dev >/dev/null
cmake --build --preset dev --target write_stability
table=$(mktemp)
trap 'rm -f "$table"' EXIT
build/dev/tests/stability/write_stability tests/stability/introduction.md >"$table"
if grep -q WRONG "$table"; then
    grep WRONG "$table" >&2
    echo "stability: wrong, see above; docs/stability.md is as it was" >&2
    exit 1
fi
cp "$table" docs/stability.md
echo "stability: docs/stability.md"
