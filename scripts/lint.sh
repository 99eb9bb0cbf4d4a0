#!/usr/bin/env bash
# Checks form: clang-format (version 14) and at most 100 columns over all our sources, that every public header compiles alone,
# and, with --tidy, clang-tidy (version 14; minutes) over the files that changed since a revision.
#
#   scripts/lint.sh [--tidy [REVISION]]      default revision: HEAD~1
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

scripts/setup.sh --tools
git ls-files '*.h' '*.cpp' '*.c' | xargs clang-format --dry-run --Werror
# clang-format leaves comments and texts as they are.
if git ls-files '*.h' '*.cpp' '*.c' | xargs grep -nE '^.{101,}$'; then
    echo "lint: these lines have more than 100 columns" >&2
    exit 1
fi
cmake --preset dev >/dev/null
cmake --build --preset dev --target all_verify_interface_header_sets
if [ "${1:-}" = --tidy ]; then
    mapfile -t files < <(git diff --name-only --diff-filter=d "${2:-HEAD~1}" -- '*.cpp')
    [ ${#files[@]} -eq 0 ] || clang-tidy -p build/dev --quiet --warnings-as-errors='*' "${files[@]}"
fi
echo "lint: nothing to say"
