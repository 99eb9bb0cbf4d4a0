#!/usr/bin/env python3
"""Makes the pictures of docs/shapes.md anew: each native shape in three slices, and its projection.

    shape_pictures.py [NAME...]      all shapes, or these; into docs/images/shapes

    --bin FOLDER       where pent-mesh and pent-render are; default: build/release/bin

Each shape is turned in xw and yw, so that slices are no mirror images of each other.
"""

from __future__ import annotations

import argparse
import pathlib
import subprocess
import tempfile

from shape_quality import ROOT, SHAPES, shape_text

# Where it is sliced besides at 0 (m), and edges (m).
LOOKS = {
    "ball": (0.5, 0.85, 0.12), "capsule": (0.45, 0.9, 0.1), "spheritorus": (0.25, 0.5, 0.08),
    "torisphere": (0.3, 0.6, 0.1), "tiger": (0.35, 0.7, 0.1), "ditorus": (0.3, 0.55, 0.08),
    "clifford_torus": (0.4, 0.8, 0.1), "duocylinder": (0.35, 0.7, 0.1),
    "spherinder": (0.35, 0.7, 0.1), "cubinder": (0.35, 0.7, 0.1), "box": (0.35, 0.7, 0.1),
    "5-cell": (0.4, 0.8, 0.1), "8-cell": (0.35, 0.7, 0.1), "16-cell": (0.35, 0.7, 0.1),
    "24-cell": (0.35, 0.6, 0.08), "120-cell": (0.4, 0.75, 0.1), "600-cell": (0.4, 0.75, 0.1),
}
BEYOND = 9  # a slice beyond all of them: the projection alone


def draw(bin: pathlib.Path, name: str) -> None:
    first, second, edge = LOOKS[name]
    target = ROOT / "docs" / "images" / "shapes" / f"{name}.png"
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="shape_pictures-") as folder:
        shape = pathlib.Path(folder) / "shape.toml"
        body = pathlib.Path(folder) / "shape.pent"
        shape.write_text(shape_text(SHAPES[name][0], 0))
        subprocess.run([bin / "pent-mesh", shape, "-o", body, "--edge-length", str(edge), "--yes",
                        "--quiet"], check=True)
        subprocess.run([bin / "pent-render", body, "--sheet", target, "--rotate", "xw:25",
                        "--rotate", "yw:15", "--w", f"0,{first},{second},{BEYOND}", "--project",
                        "orthographic", "--color", "w", "--range", "-1.2,1.2", "--no-caption",
                        "--no-floor", "--size", "480x360", "--quiet"], check=True)
    print(target.relative_to(ROOT), flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(usage="shape_pictures.py [NAME...] [--bin FOLDER]")
    parser.add_argument("names", nargs="*", metavar="NAME", help="of " + ", ".join(LOOKS))
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build" / "release" / "bin")
    arguments = parser.parse_args()
    for name in arguments.names:
        if name not in LOOKS:
            parser.error(f'no shape "{name}"; expected of ' + ", ".join(LOOKS))
    for name in arguments.names or LOOKS:
        draw(arguments.bin, name)


if __name__ == "__main__":
    main()
