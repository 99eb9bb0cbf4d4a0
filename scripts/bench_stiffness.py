#!/usr/bin/env python3
"""Measures what steps of one body take over its stiffness, beside another build of pent-sim where one is given.

    scripts/bench_stiffness.py MESH [--young 1e4,1e2,1] [--before OTHER/pent-sim] [--write FILE.md]

MESH is a body of three or four dimensions: .pent, or any file of tetrahedra that pent-mesh reads, as the .tobj of HOBAK.
It is held where y is lowest, and falls by its weight. Programs take turns, round by round, so that what else the
machine does meets all of them; each round counts the median of its steps but the first, which sets up. The bunny of
HOBAK, of 22,706 tetrahedra:

    scripts/bench_stiffness.py bunny_3.tobj --young 1,1e2,1e4 --scale 0.01 --poisson 0.4 --density 1 --rate 60 --threads 1
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

SCENE = """[scene]
dimension = {dimension}
gravity = {gravity}
frames = {steps}
frames_per_second = {rate}
steps_per_frame = 1
[solver]
tolerance = {tolerance}
[[body]]
name = "body"
mesh = "body.pent"
material = {{ model = "stable-neo-hookean", young = {young}, poisson = {poisson}, density = {density} }}
"""
HELD = """[[constraint]]
body = "body"
select = {{ half_space = {{ normal = {normal}, offset = {offset} }} }}
"""
AXES = "xyzw"


def vector(dimension, y):
    """A multiple of the unit vector along y."""
    return "[" + ", ".join(f"{y if axis == 1 else 0:.17g}" for axis in range(dimension)) + "]"


def told_by(*command):
    """What a program prints; ends with its message if it fails."""
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"bench_stiffness: {command[0].name} ended with {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def make_body(programs, options, folder):
    """Makes body.pent; returns its dimension, cells and extent along y."""
    body = folder / "body.pent"
    if options.mesh.suffix == ".pent":
        body.write_bytes(options.mesh.read_bytes())
    else:
        told_by(programs / "pent-mesh", options.mesh, "--dim", "3", "--scale", str(options.scale), "-o", body, "--quiet")
    told = told_by(programs / "pent-check", body)
    dimension = int(re.search(r"dimension (\d)", told).group(1))
    cells = re.search(r"(\d+) (?:pentachora|tetrahedra)", told).group(1)
    low, high = re.search(r"\by (\S+) to ([^\s,]+)", told).groups()
    return dimension, int(cells), float(low), float(high)


def steps_of(program, scene, folder, threads):
    """The steps of a run, as report.json has them."""
    run = folder / "run"
    told_by(program, scene, "-o", run, "--force", "--quiet", "--threads", str(threads))
    return json.loads((run / "report.json").read_text(encoding="utf-8"))["steps"]


def measured(programs, options, scene, folder):
    """Seconds a step (median of rounds) and iterations (median of steps) of each program."""
    seconds = {program: [] for program in programs}
    iterations = {}
    for _ in range(options.rounds):
        for program in programs:
            steps = steps_of(program, scene, folder, options.threads)[1:]
            seconds[program].append(statistics.median(step["seconds"] for step in steps))
            iterations[program] = statistics.median(step["iterations"] for step in steps)
    return [(statistics.median(seconds[program]), iterations[program]) for program in programs]


def rows_of(options, folder):
    """The lines of the table."""
    dimension, cells, low, high = make_body(options.programs, options, folder)
    programs = [(options.programs / "pent-sim").resolve()] + ([options.before.resolve()] if options.before else [])
    yield "| body | cells | E | iterations | ms a step |" + (" before: iterations | ms a step | faster by |" if options.before else "")
    yield "| --- " * (8 if options.before else 5) + "|"
    for young in options.young:
        text = SCENE.format(dimension=dimension, gravity=vector(dimension, -9.8), steps=options.steps, rate=options.rate, tolerance=options.tolerance,
                            young=young, poisson=options.poisson, density=options.density)
        if options.held > 0:
            text += HELD.format(normal=vector(dimension, 1), offset=f"{low + options.held * (high - low):.17g}")
        scene = folder / "scene.toml"
        scene.write_text(text, encoding="utf-8")
        (now, iterations), *before = measured(programs, options, scene, folder)
        line = f"| {options.mesh.name} | {cells} | {young} | {iterations:g} | {1e3 * now:.3g} |"
        for then, iterations_then in before:
            line += f" {iterations_then:g} | {1e3 * then:.3g} | {then / now:.2f} |"
        yield line


def moduli(text):
    """Numbers above 0, as they are written."""
    if not all(float(number) > 0 for number in text.split(",")):
        raise ValueError(text)
    return text.split(",")


def parsed():
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("--scale", type=float, default=1, help="of a mesh that is made, default 1")
    parser.add_argument("--young", type=moduli, default="1e4,1e5,1e6,1e7,1e8", help="Young's moduli, Pa; default %(default)s")
    parser.add_argument("--poisson", type=float, default=0.28, help="Poisson's ratio, default %(default)s")
    parser.add_argument("--density", type=float, default=1000, help="kg/m^dimension, default %(default)s")
    parser.add_argument("--rate", type=int, default=30, help="steps a second, default %(default)s")
    parser.add_argument("--tolerance", type=float, default=1e-4, help="of the linear solver, default %(default)s")
    parser.add_argument("--held", type=float, default=0.1, help="part of the height that is held, from below; 0 for a free body; default %(default)s")
    parser.add_argument("--steps", type=int, default=12, help="of a run, at least 2; default %(default)s")
    parser.add_argument("--rounds", type=int, default=3, help="default %(default)s")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), help="default: the number of cores")
    parser.add_argument("--programs", type=Path, default=Path("build/release/bin"), help="folder of the programs, default %(default)s")
    parser.add_argument("--before", type=Path, help="another pent-sim to compare with")
    parser.add_argument("--write", type=Path, help="a file to append the table to")
    options = parser.parse_args()
    if not options.mesh.is_file():
        sys.exit(f"bench_stiffness: there is no file {options.mesh}")
    if not (options.programs / "pent-sim").is_file():
        sys.exit(f"bench_stiffness: there is no pent-sim in {options.programs}: build the preset release, or see --programs")
    if options.before and not options.before.is_file():
        sys.exit(f"bench_stiffness: there is no program {options.before}")
    if options.steps < 2 or options.rounds < 1:
        sys.exit("bench_stiffness: expected at least 2 steps and 1 round")
    return options


def main():
    """Prints the table line by line, and appends it where it is asked for."""
    options = parsed()
    with tempfile.TemporaryDirectory() as folder:
        rows = []
        for row in rows_of(options, Path(folder)):
            print(row, flush=True)
            rows.append(row)
    if options.write:
        with options.write.open("a", encoding="utf-8") as file:
            file.write("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
