#!/usr/bin/env bash
# Builds the page of web/ into web/dist, which any static host can serve from any folder: index.html, which
# opens by a double click and which pent-view serves, and playground.js beside it, the simulator.
#
#   scripts/web.sh
#
# Installs node, npm and emscripten if they are missing, and the packages of web/package-lock.json.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh --web
if [ -e /usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake ]; then
    cmake --preset wasm
    cmake --build --preset wasm
else
    echo "web: emscripten is not where Debian has it, /usr/share/emscripten: the page will have no playground" >&2
fi
cd web
# npm leaves the lock file of what it installed among the packages.
if ! [ node_modules/.package-lock.json -nt package-lock.json ]; then
    npm ci --no-fund --no-audit
fi
npm run build
