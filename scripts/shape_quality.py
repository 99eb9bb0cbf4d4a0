#!/usr/bin/env python3
"""Meshes each native shape at random rotations and prints the table of docs/shapes.md.

    shape_quality.py [NAME...]       all shapes, or these

    --rotations N      beside the given one; default: 20, always the same ones
    --edge-length H    instead of the table's (m)
    --write            puts the rows into docs/shapes.md
    --growth [KIND...] instead: cost and memory of 100,000 to 10 million pentachora, and the
                       exponent with which the cost grows, of a ball, a tiger, a 24-cell, a
                       difference and a boundary of tetrahedra
    --order            instead: the part of the hypervolume that is missing with the table's edges
                       and with some of half that length, the order between them, and how many
                       edges across what is thinnest leave 1% of it
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
import os
import pathlib
import random
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


# Twice the radius (m) of the largest ball within.
WIDTHS = {"ball": 2, "capsule": 1.2, "spheritorus": 0.7, "torisphere": 0.7, "tiger": 0.7,
          "ditorus": 0.5, "clifford_torus": 0.7, "duocylinder": 1.6, "spherinder": 1.2,
          "cubinder": 1.2, "box": 1, "5-cell": 1.5 / 4 * 2, "8-cell": 1.2, "16-cell": 1.3,
          "24-cell": math.sqrt(2), "120-cell": 1.85, "600-cell": 1.85}

# For --growth: a shape, and edges (m) that give about 100,000, 1 million and 10 million.
GROWTH = {
    "ball": (SHAPES["ball"][0], (0.23, 0.128, 0.072)),
    "tiger": (SHAPES["tiger"][0], (0.28, 0.157, 0.0885)),
    "24-cell": (SHAPES["24-cell"][0], (0.19, 0.107, 0.06)),
    "difference": ("""ball = { radius = 1 }

[[shape]]
op = "difference"
box = { size = [1, 1, 1, 1] }
rotate = [{ plane = "xw", degrees = 30 }, { plane = "yz", degrees = 20 }]
translate = [0.8, 0.3, 0, 0]
""", (0.22, 0.125, 0.07)),
    # A duocylinder's, of edges of 0.1 m, in a file.
    "boundary": ('boundary = { file = "boundary.4off" }', (0.22, 0.125, 0.07)),
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
    command = [bin / "pent-mesh", folder / "shape.toml", "-o", folder / "mesh.pent", "--yes",
               "--quiet", "--edge-length", str(edge), "--json", folder / "report.json"]
    child = subprocess.Popen(command)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise subprocess.CalledProcessError(child.returncode, command)
    # The links of the boundary, too: exit code 1 if one is no sphere.
    subprocess.run([bin / "pent-check", folder / "mesh.pent", "--quiet"], check=True)
    report = json.loads((folder / "report.json").read_text())
    report["core_seconds"] = usage.ru_utime + usage.ru_stime
    report["bytes"] = usage.ru_maxrss * 1024
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


def write_boundary(bin: pathlib.Path, folder: pathlib.Path) -> None:
    """The boundary of a duocylinder of edges of 0.1 m, as a file of another program."""
    mesh(bin, folder, SHAPES["duocylinder"][0], 0.1, 0)
    subprocess.run([bin / "pent-convert", folder / "mesh.pent", "-o", folder / "boundary.4off",
                    "--quiet"], check=True)


def growth(bin: pathlib.Path, names: list[str]) -> None:
    """Bodies of more and more cells: the last has 100 times as many as the first."""
    print("| shape | edges, m | pentachora | core s | core s a million | bytes each |\n"
          "| --- | --- | --- | --- | --- | --- |", flush=True)
    for name in names or GROWTH:
        shape, edges = GROWTH[name]
        costs = []
        with tempfile.TemporaryDirectory(prefix="shape_quality-") as folder:
            if name == "boundary":
                write_boundary(bin, pathlib.Path(folder))
            for edge in edges:
                report = mesh(bin, pathlib.Path(folder), shape, edge, 0)
                cells, seconds = report["mesh"]["cells"], report["core_seconds"]
                costs.append((cells, seconds))
                print(f"| {name} | {edge} | {cells} | {seconds:.2f} | {1e6 * seconds / cells:.2f} "
                      f"| {report['bytes'] / cells:.0f} |", flush=True)
        (few, first), (many, last) = costs[0], costs[-1]
        print(f"{name}: exponent {math.log(last / first) / math.log(many / few):.2f}", flush=True)


def order(bin: pathlib.Path, names: list[str]) -> None:
    """How fast the hypervolume becomes right."""
    print("| shape | edges, m | missing | edges, m | missing | order | edges across for 1% |\n"
          "| --- | --- | --- | --- | --- | --- | --- |", flush=True)
    for name in names or SHAPES:
        shape, hypervolume, longer, _ = SHAPES[name]
        edges = (longer, longer / 2)
        with tempfile.TemporaryDirectory(prefix="shape_quality-") as folder:
            lost = [abs(1 - mesh(bin, pathlib.Path(folder), shape, edge, 1)["mesh"]["volume"]
                        / hypervolume) for edge in edges]
        across = WIDTHS[name] / longer * math.sqrt(lost[0] / 0.01)
        print(f"| {name} | {edges[0]} | {100 * lost[0]:.2f}% | {edges[1]} | {100 * lost[1]:.2f}% "
              f"| {math.log2(lost[0] / lost[1]):.2f} | {across:.1f} |", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(usage="shape_quality.py [NAME...] [--rotations N] [...]")
    parser.add_argument("names", nargs="*", metavar="NAME", help="of " + ", ".join(SHAPES))
    parser.add_argument("--rotations", type=int, default=20)
    parser.add_argument("--edge-length", type=float)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--growth", action="store_true")
    parser.add_argument("--order", action="store_true")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build" / "release" / "bin")
    arguments = parser.parse_args()
    known = GROWTH if arguments.growth else SHAPES
    for name in arguments.names:
        if name not in known:
            parser.error(f'no shape "{name}"; expected of ' + ", ".join(known))
    if arguments.growth:
        growth(arguments.bin, arguments.names)
        return 0
    if arguments.order:
        order(arguments.bin, arguments.names)
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
