#!/usr/bin/env bash
# From two surface files to moving 4D bodies on screen: builds the programs, then for the octopus and the
# alien makes a pentachoral mesh, simulates it, slices it, and makes a contact sheet and a movie.
# What is up to date is not made again.
#
#   scripts/demo.sh [OUTPUT FOLDER]      default: out/demo
set -euo pipefail
start=$SECONDS
out=$(realpath -m "${1:-$(dirname "$0")/../out/demo}")
cd "$(dirname "$0")/.."

scripts/setup.sh
cmake --preset release
cmake --build --preset release
built=$SECONDS
bin=$PWD/build/release/bin
mkdir -p "$out"

# is_current TARGET SOURCE...: the target exists and no source is newer
is_current() {
    local target=$1
    shift
    [ -e "$target" ] || return 1
    for source in "$@"; do
        if [ "$source" -nt "$target" ]; then
            return 1
        fi
    done
}

# make_target TARGET "SOURCES" COMMAND...: runs the command unless the target is current
make_target() {
    local target=$1 sources=$2
    shift 2
    # shellcheck disable=SC2086  # a list of files without spaces
    if is_current "$target" $sources; then
        echo "demo: ${target#"$PWD"/} is up to date"
        return
    fi
    echo "demo: $(basename "$1") ${*:2}" | sed "s#$PWD/##g"
    "$@"
    touch "$target"
}

# demo NAME SURFACE "MESHING OPTIONS" "PICTURE OPTIONS"
demo() {
    local name=$1 surface=data/models/$2 options=$3 look=$4
    local mesh=$out/$name.pent scene=$out/$name.toml run=$out/$name
    # shellcheck disable=SC2086  # several options
    make_target "$mesh" "$surface $bin/pent-mesh" \
        "$bin/pent-mesh" "$surface" -o "$mesh" $options
    make_target "$scene" "data/scenes/$name.toml" cp "data/scenes/$name.toml" "$scene"
    make_target "$run/report.json" "$mesh $scene $bin/pent-sim" \
        "$bin/pent-sim" "$scene" -o "$run" --force
    make_target "$out/$name-slices/slices.csv" "$run/report.json $bin/pent-slice" \
        "$bin/pent-slice" "$run" -o "$out/$name-slices" --frames ::15
    # shellcheck disable=SC2086
    make_target "$out/$name.png" "$run/report.json $bin/pent-render" \
        "$bin/pent-render" "$run" --sheet "$out/$name.png" $look
    # shellcheck disable=SC2086
    make_target "$out/$name.mp4" "$run/report.json $bin/pent-render" \
        "$bin/pent-render" "$run" -o "$out/$name.mp4" $look
}

demo octopus octopus_5246f.obj "--thickness 1 --layers 4" ""
demo alien alien_4006f.obj "--thickness 1 --layers 4" "--color strain --range 0,1.5"

cat <<END

demo: done in $((SECONDS - built)) s (and $((built - start)) s to install and build). Look at

  $out/octopus.png   $out/alien.png    contact sheets: the slice w = 0 over time
  $out/octopus.mp4   $out/alien.mp4    movies
  $out/octopus-slices/                 the slices as triangle meshes, for Blender or MeshLab
  $out/octopus/frames/                 the 4D frames themselves

Try next
  edit $out/octopus.toml (another plane of rotation, a softer body) and run this script again
  $bin/pent-render $out/octopus -o other.mp4 --w 0.3        another slice of the same motion
  $bin/pent-mesh YOUR.obj -o your.pent                       a mesh of your own
END
