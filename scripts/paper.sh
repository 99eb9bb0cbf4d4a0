#!/usr/bin/env bash
# Runs the scenes of the paper [shi2025]: meshes, simulates, slices and renders them by the recipes in the
# comments of data/scenes/*.toml, then checks what came out and puts our figures beside the paper's.
#
#   scripts/paper.sh [SCENE ...] [--quick] [--threads N]      default: all scenes, all cores
#
# Scenes: bunny hug alien octopus thin thick cantilevers noodles arap. --quick makes a few frames of each,
# within ten minutes. Results go to out/paper (out/paper-quick). What is up to date is not made again, a run
# that was interrupted goes on. The bunny and the armadillos want scripts/get_models.sh once; without them
# our own octopus and alien stand in.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
. scripts/scene_steps.sh

all="bunny hug alien octopus thin thick cantilevers noodles arap"
chosen=() frames='' out=out/paper threads=''
while [ $# -gt 0 ]; do
    case $1 in
        --quick) frames=3 out=out/paper-quick ;;
        --threads) threads=${2:?paper: --threads needs a number}; shift ;;
        *)
            [[ " $all " = *" $1 "* ]] || {
                echo "paper: no scene is called \"$1\"; expected one of $all, --quick or --threads N" >&2
                exit 2
            }
            chosen+=("$1")
            ;;
    esac
    shift
done
[ ${#chosen[@]} -gt 0 ] || read -ra chosen <<<"$all"

# scene_file NAME: the scene of that name, or what stands in for it
scene_file() {
    local model=data/models/research
    case $1 in
        bunny) if [ -e $model/bunny.off ]; then echo rotating_bunny; else echo octopus; fi ;;
        hug) if [ -e $model/armadillo.off ]; then echo armadillo_hug; else echo alien_hug; fi ;;
        alien | octopus) echo "$1_twist" ;;
        thin | thick) echo "$1_wring" ;;
        arap) echo noodles_arap ;;
        *) echo "$1" ;;
    esac
}

scripts/setup.sh
cmake --preset release >/dev/null
cmake --build --preset release
bin=$PWD/build/release/bin
mkdir -p "$out"
start=$SECONDS
files=()
for name in "${chosen[@]}"; do
    file=$(scene_file "$name")
    say "scene $((${#files[@]} + 1)) of ${#chosen[@]}: $file, $((SECONDS - start)) s since the start"
    make_scene "data/scenes/$file.toml" "$out" "$frames"
    files+=("$file")
done
say "all pictures, slices and runs are in $out; its table.md compares them with the paper:"
PATH=/usr/bin:$PATH python3 scripts/paper_table.py "$out" "${files[@]}"  # Debian's own, with numpy
say "done in $((SECONDS - start)) s"
