#!/usr/bin/env bash
# Builds the page of web/ into web/dist: one file, index.html, which any static host can serve from any
# folder, which opens by a double click, and which pent-view serves.
#
#   scripts/web.sh
#
# Installs node and npm if they are missing, and the packages of web/package-lock.json.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh --web
cd web
# npm leaves the lock file of what it installed among the packages.
if ! [ node_modules/.package-lock.json -nt package-lock.json ]; then
    npm ci --no-fund --no-audit
fi
npm run build
