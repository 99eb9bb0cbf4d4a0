#!/usr/bin/env bash
# Builds the site of docs/ into build/site/html: pages with search, the tutorials and the gallery, the viewer and the
# playground, and the reference of Python, C++ and C. It is static, works from any folder and from files, and loads
# nothing from elsewhere; every link in it is checked.
#
#   scripts/site.sh
#
# The playground is in it if scripts/web.sh has built it.
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/setup.sh --site
out=build/site
rm -rf "$out"
mkdir -p "$out/extra/page"
version=$(sed -n 's/^project(pent VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)

{
    cat docs/site/Doxyfile
    echo "PROJECT_NUMBER = $version"
    echo "OUTPUT_DIRECTORY = $out/extra"
    echo "HTML_OUTPUT = cpp"
} | doxygen - 2>"$out/doxygen.log"

for part in index.html playground.js; do
    if [ -e "web/dist/$part" ]; then
        cp "web/dist/$part" "$out/extra/page/"
    else
        echo "site: without $part of the viewer and the playground; scripts/web.sh builds it"
    fi
done

# Debian's own Python has Sphinx, numpy and furo.
/usr/bin/python3 docs/site/stage.py "$out/source"
PENT_SOURCE=$PWD PENT_SITE_EXTRA=$PWD/$out/extra \
    /usr/bin/python3 -m sphinx -W --keep-going -q -b html -d "$out/doctrees" "$out/source" "$out/html"
# Debian's theme has its normalize.css from the root of the host; here it comes along.
cp /usr/share/javascript/normalize.css/normalize.css "$out/html/_static/styles/"
sed -i 's|url(/javascript/normalize.css/normalize.css)|url(normalize.css)|' "$out/html/_static/styles/furo.css"
/usr/bin/python3 docs/site/links.py --site "$out/html"
echo "site: open $out/html/index.html"
