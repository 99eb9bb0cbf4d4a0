#!/usr/bin/env bash
# Fetches the bunny and the armadillo of the paper's scenes into data/models/research, from the data
# archive inside Debian's package libcgal-demo. They are not part of this repository: their terms allow
# research use only. Nothing here needs them; without them our own octopus and alien stand in.
#
#   scripts/get_models.sh
set -euo pipefail
. "$(dirname "$0")/help.sh"
cd "$(dirname "$0")/.."
target=data/models/research

cat <<'END'
get_models: the bunny and the armadillo come from the Stanford 3D Scanning Repository. Its terms, in short:
  - for research; free redistribution with credit to the Stanford Computer Graphics Laboratory
  - no commercial use, neither of the models nor of pictures of them, without permission
  - taste: no destruction or disfigurement of the models that stand for something sacred
END
if [ -e $target/bunny.off ] && [ -e $target/armadillo.off ]; then
    echo "get_models: both are in $target already"
    exit 0
fi
command -v apt-get >/dev/null || {
    echo "get_models: needs apt-get of Debian 12 to fetch the package libcgal-demo" >&2
    exit 1
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
(cd "$folder" && apt-get -o APT::Sandbox::User=root download -qq libcgal-demo) || {
    echo "get_models: libcgal-demo could not be downloaded; run apt-get update as root first" >&2
    exit 1
}
dpkg-deb --fsys-tarfile "$folder"/libcgal-demo_*.deb |
    tar -xO ./usr/share/doc/libcgal-dev/data.tar.gz |
    tar -xz -C "$folder" data/meshes/bunny00.off data/meshes/armadillo.off
mkdir -p $target
mv "$folder/data/meshes/bunny00.off" $target/bunny.off
mv "$folder/data/meshes/armadillo.off" $target/armadillo.off
echo "get_models: $target/bunny.off and $target/armadillo.off"
