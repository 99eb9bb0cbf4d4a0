#!/usr/bin/env bash
# Makes the meshes of the paper's scenes [shi2025, Table 1] and compares their counts with the paper's:
# cantilever and noodle exactly, the others within 3%. Bunny and armadillo want scripts/get_models.sh first.
#
#   scripts/paper_meshes.sh [OUTPUT FOLDER]      default: out/paper/meshes
set -euo pipefail
out=$(realpath -m "${1:-$(dirname "$0")/../out/paper/meshes}")
cd "$(dirname "$0")/.."

scripts/setup.sh
cmake --preset release >/dev/null
cmake --build --preset release --target pent-mesh pent-tetgen
mesher=build/release/bin/pent-mesh
mkdir -p "$out"
failures=0

# count KEY FILE: a number of the object "mesh" in a report
count() {
    sed -n '/"mesh": {/,/}/p' "$2" | sed -n "s/.*\"$1\": \([0-9]*\).*/\1/p" | head -1
}

# mesh NAME VERTICES PENTACHORA TOLERANCE_PERCENT OPTIONS...
mesh() {
    local name=$1 vertices=$2 pentachora=$3 tolerance=$4
    shift 4
    if [ -e "$1" ] || [ "${1#--}" != "$1" ]; then
        "$mesher" "$@" -o "$out/$name.pent" --quiet --json "$out/$name.json"
        awk -v name="$name" -v v="$(count vertices "$out/$name.json")" -v v0="$vertices" \
            -v p="$(count cells "$out/$name.json")" -v p0="$pentachora" -v tolerance="$tolerance" '
            function off(a, b) { return 100 * (a / b - 1) }
            function size(a) { return a < 0 ? -a : a }
            BEGIN {
                bad = size(off(v, v0)) > tolerance || size(off(p, p0)) > tolerance
                printf "%-12s %9d %9d %+6.2f%% %11d %11d %+6.2f%%%s\n", name, v0, v, off(v, v0),
                    p0, p, off(p, p0), bad ? "  TOO FAR" : ""
                exit bad
            }' || failures=$((failures + 1))
    else
        printf '%-12s left out: no %s (scripts/get_models.sh fetches it)\n' "$name" "$1"
    fi
}

research=data/models/research
octopus=data/models/octopus_5246f.obj
printf '%-12s %9s %9s %7s %11s %11s %7s\n' scene vertices ours off pentachora ours off
mesh bunny 7235 76176 3 $research/bunny.off \
    --surface-triangles 2508 --radius-edge-ratio 2.4 --layers 4 --thickness 0.2
mesh armadillo_7 8856 96096 3 $research/armadillo.off \
    --surface-triangles 2004 --radius-edge-ratio 1.6 --layers 7 --thickness 46
mesh armadillo_8 9963 109824 3 $research/armadillo.off \
    --surface-triangles 2004 --radius-edge-ratio 1.6 --layers 8 --thickness 53
mesh alien 23551 245040 3 data/models/alien_4006f.obj \
    --surface-triangles 4000 --radius-edge-ratio 1.7 --layers 10 --thickness 0.64
mesh octopus 24957 245184 3 $octopus \
    --surface-triangles 5248 --radius-edge-ratio 2.3 --layers 8 --thickness 0.63
mesh thin 26100 218488 3 $octopus \
    --surface-triangles 15470 --radius-edge-ratio 2.2 --layers 2 --thickness 0.1
mesh thick 28212 280260 3 $octopus \
    --surface-triangles 8608 --radius-edge-ratio 2.3 --layers 5 --thickness 0.32
mesh cantilever 17589 262144 0 --box 4,1,1,1 --size 4,1,1,1 --cut corners --subdivide 8
mesh noodle 6683 51200 0 --ball 4 --thickness 20 --layers 40

echo "paper_meshes: in $out; $failures too far from the paper's counts"
[ $failures -eq 0 ]
