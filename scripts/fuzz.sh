#!/usr/bin/env bash
# Feeds arbitrary bytes to every reader of ours with libFuzzer, under the address and undefined-
# behavior sanitizers. What it finds new stays in build/fuzz/corpus and is the start of the next run.
#
#   scripts/fuzz.sh [SECONDS [READER...]]    default: 60 seconds for each reader
#
# Exit code 1 if a reader breaks; the input that broke it is then in build/fuzz/found: move it to
# tests/fuzz/corpus/READER, where the tests replay it, and mend the reader.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

seconds=${1:-60}
shift || true
[[ $seconds =~ ^[0-9]+$ ]] || { echo "fuzz: expected seconds, not \"$seconds\": scripts/fuzz.sh [SECONDS [READER...]]" >&2; exit 2; }
scripts/setup.sh --tools
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz

readers=("$@")
if [ ${#readers[@]} -eq 0 ]; then
    # glTF is assimp's to read, in a process of its own that no fuzzer sees into; the tests replay its samples.
    mapfile -t readers < <(ls tests/fuzz/corpus | grep -v gltf)
fi
mkdir -p build/fuzz/found
broken=()
for reader in "${readers[@]}"; do
    grown=build/fuzz/corpus/$reader
    log=build/fuzz/found/$reader.log
    mkdir -p "$grown"
    if PENT_FUZZ_READER=$reader build/fuzz/bin/fuzz_readers \
        -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=65536 \
        -artifact_prefix="build/fuzz/found/$reader-" \
        "$grown" "tests/fuzz/corpus/$reader" >"$log" 2>&1; then
        echo "fuzz: $reader: $(grep -oE '^Done [0-9]+ runs' "$log" || echo done), nothing found"
    else
        broken+=("$reader")
        echo "fuzz: $reader: BROKEN, see $log"
    fi
done
[ ${#broken[@]} -eq 0 ] || { echo "fuzz: broken: ${broken[*]}; inputs in build/fuzz/found" >&2; exit 1; }
