#!/usr/bin/env bash
# Installs what is missing, builds the preset `dev` (optimized, asserts on, warnings are errors), runs
# every test and, where all are meant, a minute of random scenes from a fixed seed (docs/testing.md).
#
#   scripts/test.sh [ARGUMENTS FOR CTEST]     for example: scripts/test.sh -R Slice
#   scripts/test.sh --readers                 only the format and every reader of files under the address
#                                             and undefined-behavior sanitizers, over damaged samples
#   scripts/test.sh --threads                 only the parts that use threads, under the thread sanitizer
#   scripts/test.sh --portable                the libraries with clang++, libc++ and without threads
#   scripts/test.sh --web                     only the page of web/: builds it, its readers and its view in node,
#                                             and the page in Chromium; beside pent-slice and pent-check
#                                             where the preset dev is built
#   scripts/test.sh --page                    the same without the playground, whose module takes minutes to build
#   scripts/test.sh --python                  only the Python package: its tests, its types, 10,000 calls at random,
#                                             its wheel in a fresh environment, its notebooks
#   scripts/test.sh --python-asan             only 10,000 calls at random of the Python package, into a library with the
#                                             address and undefined-behavior sanitizers
#   scripts/test.sh --hosts                   only the add-on for Blender and the reader for ParaView, in both
#   scripts/test.sh --distributed             only what runs on many machines: scenes on 1 to 4 ranks, studies on a Slurm of
#                                             one node that the test starts and stops (as root), and with GNU parallel
#   scripts/test.sh --all                     every test, every test under the address and undefined-behavior
#                                             sanitizers, a minute of scripts/scene_fuzz.sh from a fixed
#                                             seed, --threads, --portable, --web, --python, --hosts, --distributed and scripts/site.sh
#                                             (long: each builds anew)
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

run_preset() {  # PRESET [ARGUMENTS FOR CTEST]
    "${launcher[@]}" cmake --preset "$1"
    "${launcher[@]}" cmake --build --preset "$1"
    "${launcher[@]}" ctest --preset "$@"
}

# The thread sanitizer of g++ 12 does not find its way in memory laid out as randomly as newer kernels do it.
run_threads() {
    local launcher=()
    local bits
    bits=$(cat /proc/sys/vm/mmap_rnd_bits 2>/dev/null || echo 0)
    if [ "$bits" -gt 28 ]; then
        if ! setarch -R true 2>/dev/null; then
            echo "test: the thread sanitizer needs a memory layout that is less random than here, where vm.mmap_rnd_bits" \
                "is $bits, and setarch -R is not allowed: run sysctl vm.mmap_rnd_bits=28 on the host" >&2
            exit 1
        fi
        launcher=(setarch -R)
    fi
    run_preset tsan
}

run_portable() {
    scripts/setup.sh --portable
    run_preset portable
}

run_web() {
    scripts/web.sh "$@"
    npm --prefix web test
    npm --prefix web run e2e
}

# With Debian's own Python, which has the packages.
run_python() {
    scripts/setup.sh --python
    cmake --preset dev
    cmake --build --preset dev --target wheel
    PENTIMENTO_FUZZ_CALLS=10000 /usr/bin/python3 python/tests/run.py --all
}

run_python_asan() {
    scripts/setup.sh --python
    cmake --preset asan
    cmake --build --preset asan --target pent_plugin
    ctest --preset asan --verbose -R '^Python\.CallsAtRandom$'
}

# In Blender and ParaView themselves; what is skipped, and why, stands in lines that begin with SKIPPED.
run_hosts() {
    scripts/setup.sh --hosts
    cmake --preset dev
    cmake --build --preset dev --target pent_plugin pent-sim pent-slice
    ctest --preset dev --verbose -L hosts_test
}

# What is skipped, and why, stands in lines that begin with SKIPPED.
run_distributed() {
    scripts/setup.sh --distributed
    cmake --preset dev -DPENT_BUILD_DISTRIBUTED=ON
    cmake --build --preset dev --target pent-study pent-sim pent-sim-mpi pent-mesh mpi_test session_mpi_test ranks_equality
    ctest --preset dev -L mpi_test
    ctest --preset dev --verbose -C Distributed -L distributed_test
}

launcher=()
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
    --threads)
        run_threads
        ;;
    --portable)
        run_portable
        ;;
    --web)
        run_web
        ;;
    --page)
        run_web --viewer
        ;;
    --python)
        run_python
        ;;
    --python-asan)
        run_python_asan
        ;;
    --hosts)
        run_hosts
        ;;
    --distributed)
        run_distributed
        ;;
    --all)
        run_preset dev
        run_preset asan
        scripts/scene_fuzz.sh 60 1
        run_threads
        run_portable
        run_web
        run_python
        run_hosts
        run_distributed
        scripts/site.sh
        ;;
    "")
        run_preset dev
        build/dev/bin/scene_fuzz --count 100 --seed 1 --jobs "$(nproc)" --found build/scene_fuzz/found
        ;;
    *)
        run_preset dev "$@"
        ;;
esac
