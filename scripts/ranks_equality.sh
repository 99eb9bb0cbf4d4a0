#!/usr/bin/env bash
# Whether pent-sim-mpi is pent-sim: every scene of data/scenes and data/study whose models are there, on meshes
# some times as coarse as its own, and muscles with fibers by distances for four steps, and the barrier's stress scenes for
# twelve, to tolerance 1e-8, by pent-sim and on 1, 2, 3, 4 and 7 ranks. Prints a table: how far positions differ after the first step, over how far they
# have gone, for each number of ranks, and for pent-sim itself where the last body starts 1e-13 m away (nudged): what a
# scene makes of rounding; the most after the last step; the most that energies and momenta differ
# after the first; contacts in the first step in which they hold energy; and whether all is the same: the first step to 1e-6, its
# energies and momenta too, these counts of contacts, and with a barrier no crossings at any step by a checker
# that shares no code with the search. Fails unless it is.
#
#   scripts/ranks_equality.sh [PROGRAMS [SCENE...]]     PROGRAMS: build/release/bin
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
bin=${1:-build/release/bin}
for program in pent-mesh pent-sim pent-sim-mpi ranks_equality; do
    if [ ! -x "$bin/$program" ]; then
        echo "ranks_equality: $bin/$program is missing: build it with -DPENT_BUILD_DISTRIBUTED=ON" >&2
        exit 1
    fi
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# More ranks than cores, and root, as in containers.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1
export OMPI_MCA_btl_vader_single_copy_mechanism=none
"$bin/ranks_equality" "$bin" data "$folder" "${@:2}"
