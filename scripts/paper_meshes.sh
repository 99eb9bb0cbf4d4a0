#!/usr/bin/env bash
# Makes the meshes of the paper's scenes alone, by the recipes in data/scenes, and puts their counts beside
# Table 1 of the paper [shi2025]: cantilever and noodles must meet them exactly, the others within 3%.
#
#   scripts/paper_meshes.sh        into out/paper, where paper.sh finds them; seconds beside the build
#
# The bunny and the armadillos want scripts/get_models.sh once; without it they are left out.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
. scripts/scene_steps.sh

scripts/setup.sh
cmake --preset release >/dev/null
cmake --build --preset release --target pent-mesh pent-tetgen
bin=$PWD/build/release/bin
out=out/paper
mkdir -p $out
names=()
for name in rotating_bunny armadillo_hug alien_twist octopus_twist thin_wring thick_wring cantilevers noodles; do
    scene=data/scenes/$name.toml
    missing=$(recipes Mesh "$scene" | grep -o 'data/models/research/[^ ]*' | xargs -r ls -d 2>&1 >/dev/null || true)
    if [ -n "$missing" ]; then
        say "$name left out: scripts/get_models.sh fetches its model"
        continue
    fi
    make_meshes "$scene" $out
    names+=("$name")
done
PATH=/usr/bin:$PATH python3 scripts/paper_table.py --meshes $out "${names[@]}"  # Debian's own, with numpy
