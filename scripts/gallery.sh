#!/usr/bin/env bash
# The scenes beyond the paper, bodies that are tied, driven and alive, and shapes of four dimensions:
# makes their meshes, runs them, and makes slices, contact sheets and movies, by the recipes in the
# comments of their files. Each takes about a minute on two cores. What is up to date is not made again.
#
#   scripts/gallery.sh                       all of octopus_crawl octopus_rope puppet walker bones
#                                            duocylinders twentyfour_cell
#   scripts/gallery.sh puppet walker         these
#
# The results are in out/gallery; docs/gallery.md shows them.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
. scripts/scene_steps.sh

all=(octopus_crawl octopus_rope puppet walker bones duocylinders twentyfour_cell)
names=("$@")
[ $# -gt 0 ] || names=("${all[@]}")
for name in "${names[@]}"; do
    if [ ! -e "data/scenes/$name.toml" ]; then
        echo "gallery: no data/scenes/$name.toml; expected some of ${all[*]}" >&2
        exit 2
    fi
done
scripts/setup.sh
cmake --preset release
cmake --build --preset release
bin=$PWD/build/release/bin
out=$PWD/out/gallery
for name in "${names[@]}"; do
    mkdir -p "$out/$name"
    make_scene "data/scenes/$name.toml" "$out/$name"
done
say "look at $out/*/*.png and *.mp4"
