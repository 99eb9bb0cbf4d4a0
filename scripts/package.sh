#!/usr/bin/env bash
# Makes the packages, out of the preset `release`, into out/packages: for Debian 12 pentimento (programs, and the
# library of the C interface) and pentimento-dev (what C++ hosts link); an archive that works in any folder; the
# wheel of the Python package; and SHA256SUMS of all. docs/install.md says what each needs.
#
# The page of pent-view is in them if scripts/web.sh has built it. DEBFULLNAME and DEBEMAIL, as Debian's own tools have
# them, are who maintains the packages for Debian.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/setup.sh --package
if [ ! -e web/dist/index.html ]; then
    echo "package: without the page of pent-view; scripts/web.sh builds it"
elif [ ! -e web/dist/playground.js ]; then
    echo "package: the page has no playground; scripts/web.sh builds it"
fi
contact=(-UPENT_PACKAGE_CONTACT)
if [ -n "${DEBEMAIL:-}" ]; then
    contact=("-DPENT_PACKAGE_CONTACT=${DEBFULLNAME:-$(whoami)} <$DEBEMAIL>")
else
    echo "package: nobody's packages, as DEBFULLNAME and DEBEMAIL do not say whose they are: do not hand them on"
fi
cmake --preset release "${contact[@]}"
cmake --build --preset release
cmake --build --preset release --target wheel

out=out/packages
rm -rf "$out"
mkdir -p "$out"
cpack --config build/release/CPackConfig.cmake -B "$out" >build/release/cpack.log || {
    cat build/release/cpack.log >&2
    exit 1
}
rm -rf "$out/_CPack_Packages"
cp build/release/dist/*.whl "$out"
# The library is for hosts that load it, and goes with the programs rather than into a package of its own; CPack calls
# ldconfig itself, beside the trigger.
lintian --allow-root --fail-on error --suppress-tags package-name-doesnt-match-sonames,maintscript-calls-ldconfig \
    "$out"/*.deb
cd "$out"
sha256sum -- * >SHA256SUMS
du --apparent-size --block-size=kB -- * | sed 's/^/package: /'
