#!/usr/bin/env bash
# What pent-sim-mpi needs on more and more ranks: iterations, ghosts, memory, messages of one step, as a table for
# docs/distributed.md. Counts do not depend on how busy a machine is; times would, and are left out.
#
#   scripts/ranks.sh [CELLS...]     cells along x,y,z,w of boxes of 0.1 m; 24 pentachora a cell
#   RANKS="1 2 4" scripts/ranks.sh 10,10,10,11
#
# PRESET names the build to use (release), which must have PENT_BUILD_DISTRIBUTED.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

bin=$PWD/build/${PRESET:-release}/bin
boxes=("$@")
if [ ${#boxes[@]} -eq 0 ]; then
    boxes=(10,10,10,11 14,14,15,16)
fi
for program in pent-mesh pent-sim pent-sim-mpi; do
    if [ ! -x "$bin/$program" ]; then
        echo "ranks: $bin/$program is missing: build it with -DPENT_BUILD_DISTRIBUTED=ON" >&2
        exit 1
    fi
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# More ranks than cores, and root, as in containers.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1

# "box: 264000 pentachora" by pent-sim, then by so many ranks: what a step in memory tells.
explain() {  # RANKS TOLERANCE
    sed "s/TOLERANCE/$2/" "$folder/scene.toml" >"$folder/now.toml"
    if [ "$1" -eq 0 ]; then
        "$bin/pent-sim" --explain "$folder/now.toml" --threads 1
    else
        mpirun -q --oversubscribe --bind-to none -n "$1" "$bin/pent-sim-mpi" --explain "$folder/now.toml" --threads 1
    fi
}

iterations() {
    sed -n 's/.*: \([0-9]*\) iterations.*/\1/p'
}

for box in "${boxes[@]}"; do
    size=$(echo "$box" | awk -F, '{ printf "%g,%g,%g,%g", $1 / 10, $2 / 10, $3 / 10, $4 / 10 }')
    "$bin/pent-mesh" --box "$box" --size "$size" -o "$folder/box.pent" --quiet --yes
    cat >"$folder/scene.toml" <<SCENE
[scene]
gravity = [0, -9.8, 0, 0]
[[body]]
name = "box"
mesh = "box.pent"
material = { young = 1e7 }
[[constraint]]
body = "box"
select = { half_space = { normal = [1, 0, 0, 0], offset = $(echo "$box" | awk -F, '{ print 1e-6 - $1 / 20 }') } }
[solver]
tolerance = TOLERANCE
SCENE
    echo
    echo "**$(echo "$box" | awk -F, '{ print 24 * $1 * $2 * $3 * $4 }') pentachora**, $box cells, a step of 1/30 s, E = 1e7 Pa:"
    echo
    echo "| ranks | iterations to 1e-3 | to 1e-6 | vertices of one | ghosts of one | memory of one | messages a step | sent a step |"
    echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
    echo "| pent-sim | $(explain 0 1e-3 | iterations) | $(explain 0 1e-6 | iterations) | | | | | |"
    for ranks in ${RANKS:-1 2 4 8 16}; do
        rough=$(explain "$ranks" 1e-3)
        fine=$(explain "$ranks" 1e-6)
        line=$(echo "$fine" | grep '^ranks')
        number() { echo "$line" | sed -n "s/.*$1.*/\1/p"; }
        echo "| $ranks | $(echo "$rough" | iterations) | $(echo "$fine" | iterations)" \
            "| $(number 'at most \([0-9]*\) vertices') | $(number ', \([0-9]*\) ghosts')" \
            "| $(number 'and \([0-9]*\) MB in memory') MB | $(number 'takes \([0-9]*\) messages')" \
            "| $(number 'and \([0-9.e+]*\) MB in all') MB |"
    done
done
