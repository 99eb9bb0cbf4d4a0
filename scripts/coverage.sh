#!/usr/bin/env bash
# Builds with counters on every line, runs the tests, and says what none of them reached: a table of
# the parts, the functions never called, and a page of every file.
#
#   scripts/coverage.sh [ARGUMENTS FOR CTEST]     the page is build/coverage/report/index.html
#
# Programs that tests start count as well, those that tests kill or start as another user do not. Lines
# of code that exists once for each dimension or number type count once. Left out are lines marked
# GCOVR_EXCL, with the reason beside them. The compiler puts functions into their callers after it has begun
# to count (-fno-early-inlining), not before; a few of templates are said to be never called all the same.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

scripts/setup.sh --tools
cmake --preset coverage >/dev/null
find build/coverage -name '*.gcda' -delete
cmake --build --preset coverage
ctest --preset coverage "$@" \
    || echo "coverage: some tests failed; what they reached counts all the same"
report=build/coverage/report
mkdir -p $report
trap 'rm -f ./*.gcov' EXIT  # gcovr leaves them when it is interrupted
gcovr -j "$(nproc)" --root . --filter '(format|mesher|contact|simulator|runs|viewer|study|apps)/' \
    --exclude-unreachable-branches --exclude-throw-branches \
    --html-details $report/index.html --json $report/coverage.json build/coverage
python3 scripts/coverage_table.py $report/coverage.json
echo "coverage: $report/index.html; uncovered lines of a part: python3 scripts/coverage_table.py $report/coverage.json PART"
