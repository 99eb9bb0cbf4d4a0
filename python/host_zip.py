"""Packs what Blender and ParaView load: add-on or plug-in, and in it this package and the library.

host_zip.py blender|paraview FOLDER    PENTIMENTO_BUILD names the build, as for the wheel
"""

from __future__ import annotations

import pathlib
import sys

from build_backend import HERE, ROOT, built, stripped, version, write_zip

# Host: its sources, and where the zip has them.
SOURCES = {
    "blender": (ROOT / "blender" / "pentimento_slices", "pentimento_slices"),
    "paraview": (ROOT / "paraview" / "pentimento_paraview", "pentimento_paraview"),
}


def contents(host: str) -> dict[str, tuple[bytes, bool]]:
    """By name, the bytes and whether it is a program."""
    source, top = SOURCES[host]
    sources = sorted(source.glob("*.py"))
    files = {f"{top}/{path.name}": (path.read_bytes(), False) for path in sources}
    if host == "blender":  # which shows the version of an add-on
        numbers = version().replace(".", ", ")
        main = f"{top}/__init__.py"
        text = files[main][0].replace(b'"version": (0, 0, 0)', f'"version": ({numbers})'.encode())
        files[main] = (text, False)
    files[f"{top}/LICENSE"] = ((source.parent / "LICENSE").read_bytes(), False)
    for path in sorted((HERE / "pentimento").glob("*.py")):
        files[f"{top}/pentimento/{path.name}"] = (path.read_bytes(), False)
    # Without a wheel's metadata the package does not know its version.
    stated = f'"""The version."""\n\n__version__ = "{version()}"\n'
    files[f"{top}/pentimento/_version.py"] = (stated.encode(), False)
    library = built() / "plugin" / "libpent_plugin.so.2"
    files[f"{top}/pentimento/lib/{library.name}"] = (stripped(library.resolve()), True)
    return files


def pack(host: str, folder: pathlib.Path) -> pathlib.Path:
    """Writes the zip, and says where it is."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"pentimento-{host}-{version()}.zip"
    write_zip(path, contents(host))
    return path


if __name__ == "__main__":
    print(pack(sys.argv[1], pathlib.Path(sys.argv[2])))
