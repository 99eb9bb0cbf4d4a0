#!/usr/bin/env bash
# Installs the Debian packages that Pentimento is built with, those that are missing.
#
#   scripts/setup.sh            what building, testing and the demo need
#   scripts/setup.sh --tools    also what lint.sh, coverage.sh and fuzz.sh need
#   scripts/setup.sh --portable also what test.sh --portable needs: clang, libc++, the sources of GoogleTest
#   scripts/setup.sh --page     also what web.sh --viewer and test.sh --page need: node, npm, Chromium
#   scripts/setup.sh --web      also what web.sh and test.sh --web need: node, npm, emscripten, Chromium
#   scripts/setup.sh --python   also what test.sh --python needs: pytest, mypy, tqdm, meshio, Jupyter's nbconvert
#   scripts/setup.sh --hosts    also what test.sh --hosts needs: Blender, ParaView, a display in memory (1.2 GB)
#   scripts/setup.sh --distributed also what test.sh --distributed needs: PETSc, MPI, Slurm, GNU parallel
#   scripts/setup.sh --site     also what site.sh needs: Sphinx, MyST, Furo, Doxygen
#   scripts/setup.sh --package  also what package.sh needs: dpkg-dev, lintian
#   scripts/setup.sh --check    only say what is missing; exit code 1 if anything is
#
# Works as root or with sudo. Safe to run again: when nothing is missing it does nothing.
set -euo pipefail
. "$(dirname "$0")/help.sh"

with_tools=false
with_portable=false
with_page=false
with_web=false
with_python=false
with_hosts=false
with_distributed=false
with_site=false
with_package=false
only_check=false
for argument in "$@"; do
    case $argument in
        --tools) with_tools=true ;;
        --portable) with_portable=true ;;
        --page) with_page=true ;;
        --web) with_page=true; with_web=true ;;
        --python) with_python=true ;;
        --hosts) with_hosts=true ;;
        --distributed) with_distributed=true ;;
        --site) with_site=true ;;
        --package) with_package=true ;;
        --check) only_check=true ;;
        *) echo "setup: unknown argument $argument; expected --tools, --portable, --page, --web, --python, --hosts, --distributed, --site, --package or --check" >&2; exit 2 ;;
    esac
done

packages=(
    g++ cmake ninja-build ccache  # build
    libeigen3-dev                 # linear algebra
    libtbb-dev                    # threads
    libtomlplusplus-dev           # scene files
    libcli11-dev                  # command lines
    nlohmann-json3-dev            # reports
    libcgal-dev libgmp-dev libmpfr-dev libboost-graph-dev  # mesher
    libassimp-dev libtet1.5-dev   # mesher: surface files, TetGen
    libmuparser-dev               # mesher: expressions of shapes
    libexpat1-dev zlib1g-dev      # mesher: files of VTK, images that are compressed
    libembree-dev libpng-dev      # viewer: ray tracer, pictures
    libfreetype-dev fonts-dejavu-core  # viewer: captions
    libgtest-dev libbenchmark-dev # tests and benchmarks
    ffmpeg webp                   # movies, animations
    python3 python3-numpy         # the numpy reader, the table of paper.sh
)
if $with_tools; then
    packages+=(
        clang-format clang-tidy           # lint.sh
        gcovr                             # coverage.sh
        clang libclang-rt-14-dev llvm     # fuzz.sh: libFuzzer, names in what its sanitizers find
    )
fi
if $with_web; then
    packages+=(emscripten)                # the simulator for browsers
fi
if $with_page; then
    packages+=(chromium xz-utils)         # end-to-end tests; packs the simulator
    # A node from elsewhere does as well, and has npm with it.
    if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
        packages+=(nodejs npm)
    fi
fi

if $with_python; then
    packages+=(
        python3-pytest mypy python3-tqdm python3-pip python3-venv
        jupyter-nbconvert python3-ipykernel  # runs the notebooks
        python3-meshio                    # takes and gives meshes
    )
fi
if $with_hosts; then
    packages+=(
        blender
        paraview python3-paraview
        xvfb xauth libgl1-mesa-dri        # Debian's ParaView draws with X alone
    )
fi
if $with_distributed; then
    packages+=(
        libpetsc-real-dev libopenmpi-dev openmpi-bin  # one simulation on many machines
        slurm-wlm munge parallel                      # studies on many machines
    )
fi
if $with_site; then
    packages+=(
        python3-sphinx python3-myst-parser furo  # the pages of docs/
        doxygen                                  # the reference of C++
    )
fi
if $with_package; then
    packages+=(dpkg-dev file lintian)     # what a .deb depends on, and its judge
fi
if $with_portable; then
    packages+=(
        clang libc++-dev libc++abi-dev    # another compiler, another C++ library
        googletest                        # compiled for that library
    )
fi

is_installed() {
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

system=unknown
if [ -r /etc/os-release ]; then
    system=$(. /etc/os-release && echo "${ID:-unknown} ${VERSION_ID:-}")
fi
if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    echo "setup: this system ($system) is not Debian; install the counterparts of these Debian 12 packages by hand:" >&2
    printf '  %s\n' "${packages[@]}" >&2
    exit 1
fi
if [ "$system" != "debian 12" ]; then
    echo "setup: note: tried on Debian 12 only, this is $system"
fi

missing=()
for package in "${packages[@]}"; do
    is_installed "$package" || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
    echo "setup: all ${#packages[@]} packages are installed"
    exit 0
fi
if $only_check; then
    echo "setup: missing: ${missing[*]}"
    exit 1
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "setup: needs root or sudo to install: ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi
echo "setup: installing ${#missing[@]} packages: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends -o DPkg::Lock::Timeout=600 "${missing[@]}" >/dev/null
echo "setup: done"
