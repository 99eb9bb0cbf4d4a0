#!/usr/bin/env bash
# Builds with coverage counters, runs the tests, and says which lines none of them reached.
#
#   scripts/coverage.sh [ARGUMENTS FOR CTEST]     the page is build/coverage/report/index.html
set -euo pipefail
cd "$(dirname "$0")/.."

command -v gcovr >/dev/null || { echo "coverage: needs gcovr: apt-get install gcovr" >&2; exit 1; }
cmake --preset coverage >/dev/null
cmake --build --preset coverage
find build/coverage -name '*.gcda' -delete
ctest --preset coverage "$@" || echo "coverage: some tests failed; what they reached counts all the same"
mkdir -p build/coverage/report
gcovr --root . --object-directory build/coverage \
    --filter '(format|mesher|contact|simulator|viewer|study|apps)/' \
    --exclude-unreachable-branches --exclude-throw-branches \
    --html-details build/coverage/report/index.html --csv build/coverage/report/coverage.csv \
    --print-summary build/coverage
echo "coverage: build/coverage/report/index.html"
