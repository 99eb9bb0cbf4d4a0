#!/usr/bin/env bash
# What the presets cost and what error they make: studies the scenes of data/study and writes
# docs/accuracy.md with its plots. Goes on where it was interrupted; what another build of the programs measured
# has to be removed, or given another folder.
#
#   scripts/accuracy.sh [OUTPUT FOLDER]      default: out/accuracy; ten minutes on a quiet machine
set -euo pipefail
. "$(dirname "$0")/help.sh"
out=$(realpath -m "${1:-$(dirname "$0")/../out/accuracy}")
cd "$(dirname "$0")/.."

scripts/setup.sh
cmake --preset release >/dev/null
cmake --build --preset release --target pent-study pent-sim pent-mesh
cmake --preset dev >/dev/null
cmake --build --preset dev --target write_locking
PATH=/usr/bin:$PATH python3 scripts/accuracy.py build/release/bin build/dev/tests/locking/write_locking "$out" docs/accuracy.md  # Debian's own, with numpy
