#!/usr/bin/env bash
# The meshes of the paper's scenes (docs/references.bib: shi2025, Table 1), each with the vertices, base
# tetrahedra and surface triangles of its scene to 3%; cantilever and noodle exactly.
#
#   scripts/paper_meshes.sh [OUTPUT FOLDER] [MODELS FOLDER]
#
# default: out/paper_meshes and data/models. Bunny and armadillo are made if the models folder has
# bunny_2520f.obj and armadillo_2002f.obj; they may not be distributed with this program.
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(realpath -m "${1:-out/paper_meshes}")
models=$(realpath -m "${2:-data/models}")
bin=$PWD/build/release/bin
if [ ! -x "$bin/pent-mesh" ]; then
    cmake --preset release
    cmake --build --preset release --target pent-mesh
fi
mkdir -p "$out"

# mesh NAME SURFACE TRIANGLES RADIUS-EDGE-RATIO LAYERS
mesh() {
    if [ ! -e "$models/$2" ]; then
        echo "paper_meshes: no $2 in $models, $1 is left out"
        return
    fi
    echo "== $1"
    "$bin/pent-mesh" "$models/$2" -o "$out/$1.pent" --surface-triangles "$3" \
        --radius-edge-ratio "$4" --layers "$5"
}

mesh bunny bunny_2520f.obj 2508 1.6 4
mesh armadillo_left armadillo_2002f.obj 2004 1.414 7
mesh armadillo_right armadillo_2002f.obj 2004 1.414 8
mesh alien alien_4006f.obj 4000 1.7 10
mesh octopus octopus_5246f.obj 5248 2.3 8
mesh thin_wring octopus_5246f.obj 15470 2.2 2
mesh thick_wring octopus_5246f.obj 8608 2.3 5
echo "== cantilever"
"$bin/pent-mesh" --box 4,1,1,1 --size 4,1,1,1 --cut corners --subdivide 8 -o "$out/cantilever.pent"
echo "== noodle (the scene has five)"
"$bin/pent-mesh" --ball 4 --thickness 20 --layers 40 -o "$out/noodle.pent"
