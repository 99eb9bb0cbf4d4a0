#!/usr/bin/env bash
# Builds the benchmarks of the simulator for release and measures them: kernels, steps and growth, beside
# the memory and arithmetic ceilings of the machine in the same minute. The table goes to the screen and
# to benchmarks/results/simulator.md, with commit and machine. Takes one minute once it is built; leave the
# machine alone meanwhile.
#
#   scripts/bench.sh [--rounds N] [--threads N] [--no-growth]
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

build=build/bench
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPENT_BUILD_TESTS=OFF -DPENT_BUILD_BENCHMARKS=ON \
    -DPENT_BUILD_MESHER=OFF -DPENT_BUILD_VIEWER=OFF -DPENT_BUILD_APPS=OFF > /dev/null
cmake --build "$build" --target bench_simulator

commit=$(git describe --always --dirty 2> /dev/null || echo "no commit")
mkdir -p benchmarks/results
results=benchmarks/results/simulator.md
trap 'rm -f "$results.part"' EXIT  # what a run that failed or was stopped had written
"$build/bin/bench_simulator" --threads "$(nproc)" --title "Simulator, $commit, $(date +%F)" "$@" | tee "$results.part"
mv "$results.part" "$results"
echo "written to $results"
