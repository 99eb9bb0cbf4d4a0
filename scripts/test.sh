#!/usr/bin/env bash
# Installs what is missing, builds the preset `dev` (optimized, asserts on, warnings are errors) and
# runs every test.
#
#   scripts/test.sh [ARGUMENTS FOR CTEST]     for example: scripts/test.sh -R Slice
#   scripts/test.sh --all                     then the same under the address and undefined-behavior
#                                             sanitizers, and those with Thread in their name
#                                             under the thread sanitizer (long: both build anew)
set -euo pipefail
cd "$(dirname "$0")/.."

run_preset() {  # PRESET [ARGUMENTS FOR CTEST]
    cmake --preset "$1"
    cmake --build --preset "$1"
    ctest --preset "$@"
}

scripts/setup.sh
if [ "${1:-}" != --all ]; then
    run_preset dev "$@"
    exit
fi
run_preset dev
run_preset asan
run_preset tsan
