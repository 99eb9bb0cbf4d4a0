#!/usr/bin/env bash
# Installs what is missing, builds the preset `dev` (optimized, asserts on, warnings are errors) and
# runs every test.
#
#   scripts/test.sh [ARGUMENTS FOR CTEST]     for example: scripts/test.sh -R Slice
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
cmake --preset dev
cmake --build --preset dev
ctest --preset dev "$@"
