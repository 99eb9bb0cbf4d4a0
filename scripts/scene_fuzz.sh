#!/usr/bin/env bash
# Draws small scenes at random, over every key and every pair of features, and runs each under the address and
# undefined-behavior sanitizers in every way that a law is about: docs/testing.md has the laws.
#
#   scripts/scene_fuzz.sh [SECONDS [SEED]]    default: 60 seconds from seed 1 on
#
# Exit code 1 if a scene breaks a law; it is then in build/scene_fuzz/found, shrunk, with what was seen. Mend the
# defect and move its scene.toml to tests/scene_fuzz/samples/NAME.toml, where the tests run it.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

seconds=${1:-60}
seed=${2:-1}
[[ $seconds =~ ^[0-9]+$ && $seed =~ ^[0-9]+$ ]] || {
    echo "scene_fuzz: expected whole numbers: scripts/scene_fuzz.sh [SECONDS [SEED]]" >&2
    exit 2
}
scripts/setup.sh
cmake --preset asan >/dev/null
cmake --build --preset asan --target scene_fuzz
# The search for leaks traces the process, which containers often forbid.
export ASAN_OPTIONS=detect_leaks=0
build/asan/bin/scene_fuzz --seconds "$seconds" --seed "$seed" --jobs "$(nproc)" --found build/scene_fuzz/found
