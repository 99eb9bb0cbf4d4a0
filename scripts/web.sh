#!/usr/bin/env bash
# Builds the page of web/ into web/dist, which any static host can serve from any folder: index.html, which
# opens by a double click and which pent-view serves, and playground.js beside it, the simulator.
#
#   scripts/web.sh             both
#   scripts/web.sh --viewer    index.html alone, which takes seconds; the page has a playground then only where the
#                              simulator was built before
#
# Installs node, npm and emscripten if they are missing, and the packages of web/package-lock.json.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

case ${1:-} in
    "") scripts/setup.sh --web ;;
    --viewer) scripts/setup.sh --page ;;
    *) echo "web: unknown argument $1; expected --viewer or nothing" >&2; exit 2 ;;
esac
if [ "${1:-}" != --viewer ]; then
    if [ ! -e /usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake ]; then
        echo "web: emscripten is not where Debian has it, /usr/share/emscripten; scripts/web.sh --viewer does without" >&2
        exit 1
    fi
    cmake --preset wasm
    cmake --build --preset wasm
fi
cd web
# npm leaves the lock file of what it installed among the packages.
if ! [ node_modules/.package-lock.json -nt package-lock.json ]; then
    npm ci --no-fund --no-audit
fi
npm run build
