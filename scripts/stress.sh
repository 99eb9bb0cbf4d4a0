#!/usr/bin/env bash
# Runs the barrier's stress scenes, in three and four dimensions, finer than the tests: fast impact, stacked
# noodles, a needle at a narrow gap, interlocked hooks, stiffness one to a million, thin sheets. A
# brute-force checker looks at every accepted step and at all ways between; prints a table, and fails if a
# step is refused or anything crosses. Takes about ten minutes; --fine 1 is as the tests, 3 takes hours.
#
#   scripts/stress.sh [--fine N]
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

build=build/bench
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPENT_BUILD_TESTS=OFF -DPENT_BUILD_BENCHMARKS=ON \
    -DPENT_BUILD_MESHER=OFF -DPENT_BUILD_VIEWER=OFF -DPENT_BUILD_APPS=OFF > /dev/null
cmake --build "$build" --target stress_barrier
"$build/bin/stress_barrier" "$@"
