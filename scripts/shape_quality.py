#!/usr/bin/env python3
"""Meshes each native shape at random rotations and prints the table of docs/shapes.md.

    shape_quality.py [NAME...]       all shapes, or these

    --rotations N      beside the given one; default: 20, always the same ones
    --edge-length H    instead of the table's (m)
    --write            puts the rows into docs/shapes.md
    --growth           instead: cost and memory of 100,000 to 10 million pentachora, and the
                       exponent with which the cost grows
    --bin FOLDER       where pent-mesh and pent-check are; default: build/release/bin

A row has the worst and the lowest mean of the mean ratio over all rotations, the largest part of
hypervolume that is missing, the most simplices of the boundary that cross a ridge, and what a
million pentachora cost of one core, and of memory, in the largest mesh. Exit code 1 if a mesh is
not sound, or misses what is asked of it: a worst of 0.2 and a mean of 0.8 where the shape is
smooth, 0.1 and 0.7 where it has ridges.
"""

from __future__ import annotations

import argparse
import json
import math
import pathlib
import random
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PI = math.pi
ROOT5 = math.sqrt(5)
HEADER = ("| shape | edges, m | pentachora | worst | mean | missing | beveled | core s a million "
          "| bytes each |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
PLANES = ("xy", "xz", "xw", "yz", "yw", "zw")

# Name: the shape, its hypervolume (m^4), edges (m), whether it has ridges.
SHAPES = {
    "ball": ("ball = { radius = 1 }", PI**2 / 2, 0.2, False),
    "capsule": ("capsule = { radius = 0.6, length = 1 }",
                PI**2 / 2 * 0.6**4 + 4 / 3 * PI * 0.6**3, 0.2, False),
    "spheritorus": ("spheritorus = { ring_radius = 0.8, tube_radius = 0.35 }",
                    8 / 3 * PI**2 * 0.8 * 0.35**3, 0.15, False),
    "torisphere": ("torisphere = { ring_radius = 0.8, tube_radius = 0.35 }",
                   4 * PI**2 * 0.35**2 * (0.8**2 + 0.35**2 / 4), 0.2, False),
    "tiger": ("tiger = { ring_radii = [0.8, 0.8], tube_radius = 0.35 }",
              4 * PI**3 * 0.64 * 0.35**2, 0.2, False),
    "ditorus": ("ditorus = { ring_radii = [0.9, 0.5], tube_radius = 0.25 }",
                4 * PI**3 * 0.45 * 0.25**2, 0.15, False),
    "clifford_torus": ("clifford_torus = { radius = 1, thickness = 0.7 }",
                       PI**3 / 2 * 0.49, 0.2, False),
    "duocylinder": ("duocylinder = { radii = [0.8, 0.8] }", PI**2 * 0.8**4, 0.2, True),
    "spherinder": ("spherinder = { radius = 0.8, length = 1.2 }", 4 / 3 * PI * 0.512 * 1.2, 0.2,
                   True),
    "cubinder": ("cubinder = { radius = 0.8, size = [1.2, 1.2] }", PI * 0.64 * 1.44, 0.2, True),
    "box": ("box = { size = [1.5, 1.2, 1, 1.3] }", 1.5 * 1.2 * 1.3, 0.2, True),
    "5-cell": ("polytope = { cells = 5, radius = 1.5 }",
               ROOT5 / 96 * (1.5 * math.sqrt(2.5)) ** 4, 0.2, True),
    "8-cell": ("polytope = { cells = 8, radius = 1.2 }", 1.2**4, 0.2, True),
    "16-cell": ("polytope = { cells = 16, radius = 1.3 }", (1.3 * math.sqrt(2)) ** 4 / 6, 0.2,
                True),
    "24-cell": ("polytope = { cells = 24, radius = 1 }", 2, 0.2, True),
    "120-cell": ("polytope = { cells = 120, radius = 1 }",
                 15 / 4 * (105 + 47 * ROOT5) * (math.sqrt(2) / (3 + ROOT5)) ** 4, 0.15, True),
    "600-cell": ("polytope = { cells = 600, radius = 1 }",
                 25 / 4 * (2 + ROOT5) * (2 / (1 + ROOT5)) ** 4, 0.1, True),
}


def shape_text(shape: str, seed: int) -> str:
    if seed == 0:
        return f"[[shape]]\n{shape}\n"
    draw = random.Random(seed)
    turns = ", ".join(
        f'{{ plane = "{plane}", degrees = {draw.uniform(-180, 180):.6f} }}' for plane in PLANES)
    return f"[[shape]]\n{shape}\nrotate = [{turns}]\n"


def mesh(bin: pathlib.Path, folder: pathlib.Path, shape: str, edge: float, seed: int) -> dict:
    """What pent-mesh reports, with the seconds of a core and the bytes that it took."""
    (folder / "shape.toml").write_text(shape_text(shape, seed))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([bin / "pent-mesh", folder / "shape.toml", "-o", folder / "mesh.pent", "--yes",
                    "--quiet", "--edge-length", str(edge), "--json", folder / "report.json"],
                   check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    # The links of the boundary, too: exit code 1 if one is no sphere.
    subprocess.run([bin / "pent-check", folder / "mesh.pent", "--quiet"], check=True)
    report = json.loads((folder / "report.json").read_text())
    report["core_seconds"] = (after.ru_utime + after.ru_stime
                              - before.ru_utime - before.ru_stime)
    report["bytes"] = after.ru_maxrss * 1024  # the largest child so far
    return report


def row(bin: pathlib.Path, name: str, rotations: int, edge: float | None) -> tuple[str, bool]:
    """The row of a shape, and whether it is as good as is asked."""
    shape, hypervolume, usual_edge, has_ridges = SHAPES[name]
    length = edge or usual_edge
    with tempfile.TemporaryDirectory(prefix="shape_quality-") as folder:
        reports = [mesh(bin, pathlib.Path(folder), shape, length, seed)
                   for seed in range(rotations + 1)]
    ratios = [report["quality"]["mean_ratio"] for report in reports]
    worst = min(ratio["min"] for ratio in ratios)
    mean = min(ratio["mean"] for ratio in ratios)
    lost = max(abs(1 - report["mesh"]["volume"] / hypervolume) for report in reports)
    beveled = max(report["mesh"]["beveled"] for report in reports)
    largest = max(reports, key=lambda report: report["mesh"]["cells"])
    cells = largest["mesh"]["cells"]
    is_good = worst >= (0.1 if has_ridges else 0.2) and mean >= (0.7 if has_ridges else 0.8)
    text = (f"| {name} | {length} | {cells} | {worst:.2f} | {mean:.2f} | {100 * lost:.1f}% "
            f"| {beveled} | {1e6 * largest['core_seconds'] / cells:.1f} "
            f"| {largest['bytes'] / cells:.0f} |")
    return text + ("" if is_good else " missed |"), is_good


def write_rows(rows: dict[str, str]) -> None:
    """Puts rows in the place of those of the same shapes, or where they belong in the table."""
    page = ROOT / "docs" / "shapes.md"
    before, _, rest = page.read_text().partition(HEADER + "\n")
    if not rest:
        raise SystemExit(f"{page}: no table that begins with {HEADER.splitlines()[0]}")
    lines = rest.splitlines(keepends=True)
    count = next(i for i, line in enumerate(lines) if not line.startswith("|"))
    old = {line.split("|")[1].strip(): line.rstrip("\n") for line in lines[:count]}
    merged = {**old, **rows}
    table = [merged[name] for name in SHAPES if name in merged]
    page.write_text(before + "\n".join([HEADER, *table]) + "\n" + "".join(lines[count:]))


def growth(bin: pathlib.Path) -> None:
    """Balls and tigers of more and more cells: the last has 100 times as many as the first."""
    print("| shape | edges, m | pentachora | core s | core s a million | bytes each |\n"
          "| --- | --- | --- | --- | --- | --- |", flush=True)
    for name, edges in (("ball", (0.23, 0.128, 0.072)), ("tiger", (0.28, 0.157, 0.0885))):
        costs = []
        with tempfile.TemporaryDirectory(prefix="shape_quality-") as folder:
            for edge in edges:
                report = mesh(bin, pathlib.Path(folder), SHAPES[name][0], edge, 0)
                cells, seconds = report["mesh"]["cells"], report["core_seconds"]
                costs.append((cells, seconds))
                print(f"| {name} | {edge} | {cells} | {seconds:.2f} | {1e6 * seconds / cells:.2f} "
                      f"| {report['bytes'] / cells:.0f} |", flush=True)
        (few, first), (many, last) = costs[0], costs[-1]
        print(f"{name}: exponent {math.log(last / first) / math.log(many / few):.2f}", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(usage="shape_quality.py [NAME...] [--rotations N] [...]")
    parser.add_argument("names", nargs="*", metavar="NAME", help="of " + ", ".join(SHAPES))
    parser.add_argument("--rotations", type=int, default=20)
    parser.add_argument("--edge-length", type=float)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--growth", action="store_true")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build" / "release" / "bin")
    arguments = parser.parse_args()
    for name in arguments.names:
        if name not in SHAPES:
            parser.error(f'no shape "{name}"; expected of ' + ", ".join(SHAPES))
    if arguments.growth:
        growth(arguments.bin)
        return 0
    print(HEADER, flush=True)
    is_good = True
    for name in arguments.names or SHAPES:
        text, is_row_good = row(arguments.bin, name, arguments.rotations, arguments.edge_length)
        print(text, flush=True)
        is_good = is_good and is_row_good
        if arguments.write:
            write_rows({name: text})
    return 0 if is_good else 1


if __name__ == "__main__":
    sys.exit(main())
