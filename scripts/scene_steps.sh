# Sourced by demo.sh and paper.sh: makes all there is to see of a scene, by the recipes in its comments.
# shellcheck shell=bash
#
#     # Mesh: pent-mesh INPUT -o NAME.pent OPTIONS
#     # Slices: OPTIONS             of pent-slice
#     # Picture: NAME OPTIONS       of pent-render, for a contact sheet
#     # Movie: OPTIONS              of pent-render
#
# What is up to date is not made again, and a run that was interrupted goes on. Programs are not looked
# at: remove what is to be made anew after a change of theirs. Needs $bin, where the programs are.

# say TEXT: a line under the name of the script
say() {
    echo "$(basename "$0" .sh): $*"
}

# recipes KIND SCENE: what stands behind "# KIND:"
recipes() {
    sed -n "s/^# $1:[ ]*//p" "$2"
}

# make_target TARGET "SOURCES" COMMAND...: runs the command unless the target is newer than all sources
make_target() {
    local target=$1 sources=$2 source state=current
    shift 2
    [ -e "$target" ] || state=missing
    for source in $sources; do
        [ ! "$source" -nt "$target" ] || state=old
    done
    if [ $state = current ]; then
        say "$target is up to date"
        return
    fi
    say "$(basename "$1") ${*:2}"
    "$@"
    touch "$target"
}

# make_meshes SCENE OUT: the meshes, each with the report of pent-mesh beside it
make_meshes() {
    local recipe target
    while read -r recipe; do
        target=$2/$(sed 's/.* -o \([^ ]*\).*/\1/' <<<"$recipe")
        recipe=${recipe#pent-mesh }
        # shellcheck disable=SC2086  # options
        make_target "$target" "$1" "$bin/pent-mesh" ${recipe/-o /-o $2/} \
            --json "${target%.pent}.json"
    done < <(recipes Mesh "$1")
}

# simulate SCENE RUN: runs or goes on; RUN.cpu keeps the seconds that processors were busy
simulate() {
    local scene=$1 run=$2 how=--force
    if [ -e "$run/report.json" ] && [ ! "$scene" -nt "$run/scene.toml" ]; then
        if grep -q '"verdict": "finished"' "$run/report.json"; then
            say "$run is up to date"
            return
        fi
        how=--resume
    fi
    say "pent-sim $scene -o $run $how"
    local TIMEFORMAT='%U %S'
    [ $how = --resume ] || rm -f "$run.cpu"
    { time "$bin/pent-sim" "$scene" -o "$run" $how ${threads:+--threads "$threads"} 2>&3; } \
        3>&2 2>>"$run.cpu"
}

# make_pictures SCENE RUN: slices, contact sheets and a movie
make_pictures() {
    local options name
    options=$(recipes Slices "$1")
    # shellcheck disable=SC2086
    make_target "$2-slices/slices.csv" "$2/report.json $1" \
        "$bin/pent-slice" "$2" -o "$2-slices" $options
    while read -r name options; do
        # shellcheck disable=SC2086
        make_target "$2-$name.png" "$2/report.json $1" \
            "$bin/pent-render" "$2" --sheet "$2-$name.png" $options
    done < <(recipes Picture "$1")
    while read -r options; do
        # shellcheck disable=SC2086
        make_target "$2.mp4" "$2/report.json $1" "$bin/pent-render" "$2" -o "$2.mp4" $options
    done < <(recipes Movie "$1")
}

# make_scene SCENE OUT [FRAMES]: everything into the folder OUT; FRAMES shortens the scene
make_scene() {
    local run=$2/$(basename "$1" .toml) scene
    scene=$run.toml
    make_meshes "$1" "$2"
    # Without other comments, so that a new recipe for a picture does not make a new run.
    sed -e '/^# Mesh:/p' -e '/^#/d' ${3:+-e "s/^frames = .*/frames = $3/"} "$1" >"$scene.new"
    if cmp -s "$scene.new" "$scene"; then
        rm "$scene.new"
    else
        mv "$scene.new" "$scene"
    fi
    simulate "$scene" "$run"
    make_pictures "$1" "$run"
}
