#!/usr/bin/env bash
# Installs what is missing, builds the preset `dev` (optimized, asserts on, warnings are errors) and
# runs every test.
#
#   scripts/test.sh [ARGUMENTS FOR CTEST]     for example: scripts/test.sh -R Slice
#   scripts/test.sh --readers                 only the format and every reader of files under the address
#                                             and undefined-behavior sanitizers, over damaged samples
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
case ${1:-} in
    --readers)
        cmake --preset asan
        cmake --build --preset asan --target format_test fuzz_corpus_test
        # The search for leaks traces the process, which containers often forbid.
        export ASAN_OPTIONS=detect_leaks=0
        build/asan/tests/format/format_test
        build/asan/tests/fuzz/fuzz_corpus_test
        ;;
    --all)
        run_preset dev
        run_preset asan
        run_preset tsan
        ;;
    *)
        run_preset dev "$@"
        ;;
esac
