#!/usr/bin/env python3
"""What a step of pent-sim-mpi would take on machines that are not here: a model of weak and strong scaling.

    scripts/scaling_model.py [--programs build/release/bin] [--large 20,20,20,53] [--write]

Runs a box of 1.1 million pentachora by pent-sim-mpi --explain on 1, 2, 4 and 8 ranks, takes from there what is counted (iterations,
ghosts, messages, bytes, reductions) and what one thread takes for its work, and extrapolates by formulas that are
printed beside the counts; --large looks whether they hold for a box that they were not fitted to, on 4 ranks. What a
cluster is like is assumed: see --help. With --write the tables go into docs/distributed.md.
"""

import argparse
import json
import math
import os
import re
import subprocess
import tempfile
from pathlib import Path

CELLS = (14, 14, 15, 16)  # so many that there are four levels of aggregates
ALONE = 2  # times that one rank is timed, of which the fastest counts
BYTES_OF_VECTOR = 32  # of a vertex
BYTES_OF_LIBRARIES = 35e6  # of a rank, whatever it runs
CELLS_OF_VERTEX = 24  # inside a Kuhn box
SCENE = """[scene]
gravity = [0, -9.8, 0, 0]
[[body]]
name = "box"
mesh = "box.pent"
material = { young = 1e7 }
[[constraint]]
body = "box"
select = { half_space = { normal = [1, 0, 0, 0], offset = OFFSET } }
[solver]
tolerance = 1e-3
"""


def make_box(programs, folder, cells):
    """A box of these cells of 0.1 m that is held at one end."""
    size = ",".join(f"{n / 10:g}" for n in cells)
    subprocess.run([programs / "pent-mesh", "--box", ",".join(map(str, cells)), "--size", size, "-o", folder / "box.pent", "--quiet", "--yes"],
                   check=True)
    (folder / "scene.toml").write_text(SCENE.replace("OFFSET", f"{1e-6 - cells[0] / 20}"), encoding="utf-8")


def counted(programs, folder, cells, ranks):
    """What --explain tells of so many ranks with a thread each."""
    out = folder / "explain.json"
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                       OMPI_MCA_mpi_yield_when_idle="1")
    start = os.times()
    subprocess.run(["mpirun", "-q", "--oversubscribe", "--bind-to", "none", "-n", str(ranks), programs / "pent-sim-mpi",
                    "--explain", folder / "scene.toml", "--threads", "1", "--json", out],
                   check=True, stdout=subprocess.DEVNULL, env=environment)
    end = os.times()
    used = end.children_user + end.children_system - start.children_user - start.children_system
    busy = min(1, used / (end.elapsed - start.elapsed))  # the part of a core that a rank on its own has got
    report = json.loads(out.read_text(encoding="utf-8"))
    terms = {term["name"]: term for term in report["terms"]}
    text = terms["ranks"]["why"]
    number = lambda pattern: float(re.search(pattern, text).group(1))
    return {
        "cells": cells,
        "ranks": ranks,
        "iterations": int(re.search(r": (\d+) iterations", terms["linear solver"]["why"]).group(1)),
        "vertices": number(r"at most ([\d.]+) vertices"),
        "ghosts": number(r", ([\d.]+) ghosts"),
        "memory": 1e6 * number(r"and ([\d.]+) MB in memory"),
        "bytes": 1e6 * number(r"messages and ([\d.e+]+) MB in all"),
        "reductions": number(r"([\d.]+) times all wait"),
        "assembly": busy * terms["elasticity of box"]["seconds"],
        "solve": busy * terms["linear solver"]["seconds"],
    }


def ghosts_of(vertices, layers, ranks):
    """Ghosts of a rank: columns are whole, so its part has neighbors along three axes, fewer at the rim of the body."""
    side = (vertices / ranks / layers) ** (1 / 3)
    return vertices / ranks * ((1 + 2 * (1 - ranks ** (-1 / 3)) / side) ** 3 - 1)


def levels_of(vertices):
    """Levels of aggregates: 48 vertices to one, then 6 of these, until 24 are left."""
    return max(1, 1 + math.ceil(math.log(vertices / 48 / 24, 6)))


def exchanges_of(levels):
    """Of an iteration, one after the other: two for each visit of a W-cycle, and one between both of a pair."""
    return sum(2 * 2**level for level in range(levels - 1)) + sum(2 ** (level - 1) for level in range(1, levels - 1))


def gathers_of(levels):
    """Of the coarsest level, in an iteration."""
    return 2 ** max(0, levels - 2)


def vertices_of(cells):
    return math.prod(n + 1 for n in cells)


def fitted(runs, vertices):
    """How often all vectors go to all, and columns to ghosts: least squares over the bytes of a step."""
    rows = [(BYTES_OF_VECTOR * vertices * (run["ranks"] - 1),
             BYTES_OF_VECTOR * run["ranks"] * run["ghosts"] * run["iterations"], run["bytes"]) for run in runs]
    # Relative errors, so that few ranks count as much as many.
    aa, ab, bb, ac, bc = (sum(x[i] * x[j] / x[2] ** 2 for x in rows) for i, j in ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2)))
    det = aa * bb - ab * ab
    return (bb * ac - ab * bc) / det, (aa * bc - ab * ac) / det


def part_of(vertices, ghosts, ranks):
    """Of all vertices, those that a rank has matrix and elements of."""
    return 1 / ranks + ghosts / vertices


def memory_of(runs):
    """Bytes a pentachoron that are divided and that every rank has: a line by least squares, over the part of a rank."""
    parts = [part_of(vertices_of(run["cells"]), run["ghosts"], run["ranks"]) for run in runs]
    bytes_of_one = [(run["memory"] - BYTES_OF_LIBRARIES) / (24 * math.prod(run["cells"])) for run in runs]
    part, mean = sum(parts) / len(runs), sum(bytes_of_one) / len(runs)
    divided = (sum((x - part) * (y - mean) for x, y in zip(parts, bytes_of_one, strict=True))
               / sum((x - part) ** 2 for x in parts))
    return divided, mean - divided * part


class Model:
    def __init__(self, runs, cluster):
        self.cluster = cluster
        self.cells = 24 * math.prod(CELLS)
        alone = [run for run in runs if run["ranks"] == 1]
        shared = [run for run in runs if run["ranks"] > 1]
        self.gathers, self.updates = fitted(shared, vertices_of(CELLS))
        self.iterations = max(run["iterations"] for run in runs)
        self.reductions = max(run["reductions"] / run["iterations"] for run in runs)
        self.assembly = min(run["assembly"] for run in alone) / self.cells  # s a pentachoron and core
        self.iteration = min(run["solve"] / run["iterations"] for run in alone) / self.cells
        self.bytes_divided, self.bytes_whole = memory_of(runs)

    def bytes_of_step(self, vertices, ghosts, ranks, iterations):
        return BYTES_OF_VECTOR * (self.gathers * vertices * (ranks - 1) + self.updates * iterations * ranks * ghosts)

    def step(self, cells, nodes):
        """Seconds by part, and bytes of a node."""
        c = self.cluster
        ranks = nodes * c.ranks
        vertices = cells / CELLS_OF_VERTEX
        ghosts = ghosts_of(vertices, c.layers, ranks) if ranks > 1 else 0
        doubled = 1 + ghosts * ranks / vertices / 2  # elements at borders belong to two
        cores = nodes * c.cores
        levels = levels_of(vertices)
        coarse = exchanges_of(levels) * 26 * c.latency if ranks > 1 else 0
        reductions = self.reductions + gathers_of(levels) - gathers_of(levels_of(vertices_of(CELLS)))
        waits = reductions * 2 * math.log2(ranks) * c.latency if ranks > 1 else 0
        update = (26 * c.latency + BYTES_OF_VECTOR * ghosts * c.ranks / c.network) if ranks > 1 else 0
        gather = self.gathers * BYTES_OF_VECTOR * vertices * c.ranks / c.network if nodes > 1 else 0
        work = cells / cores
        product = max(self.iteration * work, c.bytes_iteration * cells / nodes / c.memory) * doubled
        return {
            "work": doubled * self.assembly * work + self.iterations * product,
            "ghosts": self.iterations * update,
            "waiting": self.iterations * (coarse + waits),
            "gathers": gather,
        }, self.bytes_of_rank(cells, part_of(vertices, ghosts, ranks)) * c.ranks

    def bytes_of_rank(self, cells, part):
        return (self.bytes_divided * part + self.bytes_whole) * cells + BYTES_OF_LIBRARIES


def counts_table(runs, model):
    yield "| pentachora | ranks | iterations | ghosts of one | formula | sent a step | formula | memory of one | formula |"
    yield "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
    for run in runs:
        if run["ranks"] > 1:
            cells = 24 * math.prod(run["cells"])
            vertices = vertices_of(run["cells"])
            ghosts = ghosts_of(vertices, run["cells"][3] + 1, run["ranks"])
            sent = model.bytes_of_step(vertices, ghosts, run["ranks"], run["iterations"])
            memory = model.bytes_of_rank(cells, part_of(vertices, ghosts, run["ranks"]))
            yield (f"| {cells} | {run['ranks']} | {run['iterations']} | {run['ghosts']:.0f} | {ghosts:.0f} | {run['bytes'] / 1e6:.1f} MB "
                   f"| {sent / 1e6:.1f} MB | {run['memory'] / 1e6:.0f} MB | {memory / 1e6:.0f} MB |")


def scaling_table(model, sizes):
    yield "| pentachora | nodes | work | ghosts | waiting | gathers | a step | memory of a node |"
    yield "| --- | --- | --- | --- | --- | --- | --- | --- |"
    for cells, nodes in sizes:
        parts, memory = model.step(cells, nodes)
        seconds = " | ".join(f"{parts[name]:.3g} s" for name in ("work", "ghosts", "waiting", "gathers"))
        yield f"| {cells:.0e} | {nodes} | {seconds} | {sum(parts.values()):.3g} s | {memory / 1e9:.3g} GB |".replace("e+0", "e")


def report(runs, large, model):
    c = model.cluster
    strong = [(cells, nodes) for cells in (1e7, 1e8, 1e9) for nodes in (1, 4, 16, 64)]
    weak = [(1e7 * nodes, nodes) for nodes in (1, 10, 100)]
    lines = ["Counted on boxes that are solved to 1e-3, beside the formulas: by those fitted to the smaller box all vectors go to all"
             f" {model.gathers:.1f} times a step, columns to ghosts {model.updates:.2f} times an iteration. Of memory {model.bytes_divided:.0f} bytes a"
             f" pentachoron are divided, with ghosts, and {model.bytes_whole:.0f} are on every rank, beside {BYTES_OF_LIBRARIES / 1e6:.0f} MB of libraries.", "",
             *counts_table(runs + large, model), "",
             f"Measured here, one thread: {1e9 * model.assembly:.0f} ns a pentachoron for forces and matrix, {1e9 * model.iteration:.1f} ns for an iteration."
             f" Assumed: nodes of {c.cores} cores and {c.ranks} ranks, {c.memory / 1e9:.0f} GB/s of memory and {c.network / 1e9:.0f} GB/s of network,"
             f" {1e6 * c.latency:.0f} us a message, {c.layers} layers. Strong scaling:", "", *scaling_table(model, strong), "",
             "Weak scaling, ten million a node:", "", *scaling_table(model, weak)]
    return "\n".join(lines) + "\n"


def write(text):
    path = Path("docs/distributed.md")
    page = path.read_text(encoding="utf-8")
    begin, end = "<!-- scaling_model.py -->\n", "<!-- end of scaling_model.py -->\n"
    head, rest = page.split(begin)
    path.write_text(head + begin + "\n" + text + "\n" + end + rest.split(end)[1], encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--programs", type=Path, default=Path("build/release/bin"), help="folder of pent-mesh and pent-sim-mpi")
    parser.add_argument("--large", help="cells of a box to be run by 4 ranks: of 20,20,20,53 they take 5 GB")
    parser.add_argument("--write", action="store_true", help="put the tables into docs/distributed.md")
    parser.add_argument("--cores", type=int, default=64, help="of a node")
    parser.add_argument("--ranks", type=int, default=2, help="of a node: one a socket")
    parser.add_argument("--memory", type=float, default=300e9, help="bandwidth of a node, B/s")
    parser.add_argument("--network", type=float, default=25e9, help="bandwidth of a node, B/s")
    parser.add_argument("--latency", type=float, default=2e-6, help="of a message, s")
    parser.add_argument("--layers", type=int, default=12, help="of vertices along w, kept together")
    parser.add_argument("--bytes-iteration", type=float, default=90, help="read and written a pentachoron and iteration")
    cluster = parser.parse_args()
    cluster.programs = cluster.programs.absolute()
    os.chdir(Path(__file__).resolve().parent.parent)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        make_box(cluster.programs, folder, CELLS)
        runs = [counted(cluster.programs, folder, CELLS, ranks) for ranks in [1] * ALONE + [2, 4, 8]]
        large = []
        if cluster.large:
            cells = tuple(int(n) for n in cluster.large.split(","))
            make_box(cluster.programs, folder, cells)
            large.append(counted(cluster.programs, folder, cells, 4))
    text = report(runs, large, Model(runs, cluster))
    print(text)
    if cluster.write:
        write(text)


if __name__ == "__main__":
    main()
