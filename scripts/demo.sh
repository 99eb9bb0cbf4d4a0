#!/usr/bin/env bash
# From two surface files to moving 4D bodies on screen: builds the programs, then for the octopus and the
# alien makes a pentachoral mesh, simulates it, slices it, and makes a contact sheet and a movie, by the
# recipes in the comments of data/scenes/octopus.toml and alien.toml. What is up to date is not made again.
#
#   scripts/demo.sh [OUTPUT FOLDER]      default: out/demo
set -euo pipefail
. "$(dirname "$0")/help.sh"
start=$SECONDS
out=$(realpath -m "${1:-$(dirname "$0")/../out/demo}")
cd "$(dirname "$0")/.."
. scripts/scene_steps.sh

scripts/setup.sh
cmake --preset release
cmake --build --preset release
built=$SECONDS
bin=$PWD/build/release/bin
mkdir -p "$out"
for name in octopus alien; do
    make_scene data/scenes/$name.toml "$out"
done

cat <<END

demo: done in $((SECONDS - built)) s (and $((built - start)) s to install and build). In $out are

  octopus-sheet.png   alien-sheet.png    contact sheets: the slice w = 0 over time
  octopus.mp4         alien.mp4          movies
  octopus-slices/     alien-slices/      slices as triangle meshes, for Blender or MeshLab
  octopus/frames/     alien/frames/      the 4D frames themselves

Edit data/scenes/octopus.toml (another plane of rotation, a softer body) and run this script again, or try

  export PATH=$bin:\$PATH
  pent-render $out/octopus -o other.mp4 --w 0.3    # another slice of the same motion
  pent-mesh YOUR.obj -o your.pent    # a mesh of your own
  scripts/gallery.sh                 # bodies that are tied, driven and alive
  scripts/paper.sh --quick           # the scenes of the paper, a few frames of each
END
