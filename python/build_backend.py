"""Packs the wheel: this package, the library and the programs as they were built.

`pip install ./python` calls it (PEP 517); it needs nothing but Python's own library. What was built
is looked for in ../build/release, or in the folder that PENTIMENTO_BUILD names.
"""

from __future__ import annotations

import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
PROGRAMS = ("mesh", "tetgen", "sim", "slice", "render", "convert", "study", "check")
# Programs of another licence, which PENT_BUILD_MESHER leaves out.
LICENSES = {
    "mesh": ROOT / "mesher" / "LICENSE",
    "check": ROOT / "mesher" / "LICENSE",
    "tetgen": ROOT / "mesher" / "tetgen_worker" / "LICENSE",
}


def version() -> str:
    """From the one place where it stands."""
    return re.search(r"project\(pent VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]


INFO = f"pentimento-{version()}.dist-info"


def metadata() -> str:
    return f"""Metadata-Version: 2.1
Name: pentimento
Version: {version()}
Summary: Meshes and simulates deformable bodies of four spatial dimensions
License: MIT; the programs pent-mesh and pent-check GPL-3.0-or-later, pent-tetgen AGPL-3.0-or-later
Requires-Python: >=3.11
Requires-Dist: numpy >=1.24
Provides-Extra: progress
Requires-Dist: tqdm ; extra == 'progress'
Description-Content-Type: text/markdown

Bodies of four dimensions in Python: meshes, scenes, simulations, runs, slices and pictures.
"""


def built() -> pathlib.Path:
    folder = pathlib.Path(os.environ.get("PENTIMENTO_BUILD") or ROOT / "build" / "release")
    if not (folder / "plugin" / "libpent_plugin.so.2").exists():
        raise SystemExit(
            f"{folder}: has no plugin/libpent_plugin.so.2; build it by cmake --preset release &&"
            " cmake --build --preset release, or let PENTIMENTO_BUILD name another build's folder"
        )
    return folder


def stripped(path: pathlib.Path) -> bytes:
    """A program or library without what only debuggers read, where there is `strip`."""
    strip = shutil.which("strip")
    if strip is None:
        return path.read_bytes()
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder, path.name)
        shutil.copyfile(path, copy)
        subprocess.run([strip, "--strip-unneeded", str(copy)], check=True)
        return copy.read_bytes()


def contents() -> dict[str, tuple[bytes, bool]]:
    """What the wheel holds: by name, the bytes and whether it is a program."""
    folder = built()
    found = {
        f"pentimento/{path.name}": (path.read_bytes(), False)
        for path in sorted((HERE / "pentimento").iterdir())
        if path.suffix == ".py" or path.name == "py.typed"
    }
    library = folder / "plugin" / "libpent_plugin.so.2"
    found["pentimento/lib/libpent_plugin.so.2"] = (stripped(library.resolve()), True)
    for name in PROGRAMS:
        program = folder / "bin" / f"pent-{name}"
        if program.exists():
            found[f"pentimento/bin/{program.name}"] = (stripped(program), True)
            if name in LICENSES:
                license = f"{INFO}/licenses/LICENSE.{program.name}"
                found[license] = (LICENSES[name].read_bytes(), False)
        elif name not in LICENSES:
            raise SystemExit(f"{program}: is not there; build all programs first")
    return found


def build_wheel(wheel_directory: str, config_settings=None, metadata_directory=None) -> str:
    tag = "py3-none-" + re.sub(r"[-.]", "_", sysconfig.get_platform())
    files = contents()
    files[f"{INFO}/licenses/LICENSE"] = ((HERE / "LICENSE").read_bytes(), False)
    files[f"{INFO}/METADATA"] = (metadata().encode(), False)
    wheel = f"Wheel-Version: 1.0\nGenerator: pentimento\nRoot-Is-Purelib: false\nTag: {tag}\n"
    files[f"{INFO}/WHEEL"] = (wheel.encode(), False)
    record = "".join(f"{name},{digest(data)},{len(data)}\n" for name, (data, _) in files.items())
    files[f"{INFO}/RECORD"] = (f"{record}{INFO}/RECORD,,\n".encode(), False)
    name = f"pentimento-{version()}-{tag}.whl"
    write_zip(pathlib.Path(wheel_directory, name), files)
    return name


def write_zip(path: pathlib.Path, files: dict[str, tuple[bytes, bool]]) -> None:
    """As of contents(); the same bytes at any time."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, (data, is_program) in files.items():
            entry = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if is_program else 0o100644) << 16
            archive.writestr(entry, data)


def digest(data: bytes) -> str:
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def build_sdist(sdist_directory: str, config_settings=None) -> str:
    raise SystemExit("there is no source package: the wheel holds what CMake builds")


if __name__ == "__main__":  # build_backend.py FOLDER
    pathlib.Path(sys.argv[1]).mkdir(parents=True, exist_ok=True)
    print(pathlib.Path(sys.argv[1], build_wheel(sys.argv[1])))
