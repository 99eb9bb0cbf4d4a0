#!/usr/bin/env python3
"""Compares every default and range that docs/simulator.md gives for the keys of a scene with pent-sim.

    scripts/check_docs.py [BIN]      default: build/dev/bin

Defaults are read from the scene that a run writes, with defaults filled in. A value on the border of a range must
be taken or refused as the range says, and every word of a list taken. Ends with 1 and a line for each difference.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
BODY = '[[body]]\nname = "a"\nmesh = "a.pent"\n'
# A mesh of one pentachoron, in ascii.
MESH = "ply\nformat ascii 1.0\ncomment pent 1.0\ncomment dimension 4\nelement vertex 5\n" + "".join(
    f"property double {axis}\n" for axis in "xyzw") + "element pentachoron 1\n" + "".join(
    f"property uint v{i}\n" for i in range(5)) + "end_header\n" + (
    "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n0 1 2 3 4\n")
HOLD = 'body = "a"\nselect = "everything"\n'
FLOOR = "half_space = { normal = [0, 1, 0, 0], offset = -9 }\n"
# What each block needs beside the key that is looked at.
NEEDED = {"constraint": HOLD, "obstacle": FLOOR}
# Keys of one table that go together.
PAIRS = {"material.mu": ", lambda = 1", "material.lambda": ", mu = 1"}
# Blocks that a value needs as well.
TOGETHER = {"contact.model": '[solver]\nintegrator = "newton_euler"\n',
            "solver.integrator": f"[[constraint]]\n{HOLD}"}


def rows(text):
    """(block, key, {heading: cell}) of every table of keys."""
    block, headings = None, None
    for line in text.splitlines():
        if match := re.match(r"\*\*\[+(\w+)\]+\*\*", line):
            block, headings = match[1], None
        elif line.startswith("## "):
            block = None
        elif block and line.startswith("|"):
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            if headings is None:
                headings = cells
            elif not set(cells[0]) <= set("- "):
                for key in re.findall(r"`([\w.]+)(?: = [^`]*)?`", cells[0]):
                    yield block, key, dict(zip(headings, cells))


def scene(block, key, value):
    """A whole scene with this value for a key, dots in it standing for tables in tables."""
    first, *rest = key.split(".")
    for part in reversed(rest):
        value = f"{{ {part} = {value}{PAIRS.get(key, '')} }}"
    line = f"{first} = {value}\n"
    more = TOGETHER.get(f"{block}.{key}", "")
    if block == "body":
        return BODY + line + more
    if block in ("constraint", "obstacle"):
        needed = "".join(l + "\n" for l in NEEDED[block].splitlines() if not l.startswith(first + " "))
        return f"{BODY}[[{block}]]\n{needed}{line}{more}"
    return f"[{block}]\n{line}{BODY}{more}"


class Program:
    def __init__(self, folder, bin):
        self.folder, self.bin = pathlib.Path(folder), bin
        (self.folder / "a.pent").write_text(MESH)

    def run(self, text, *options):
        (self.folder / "s.toml").write_text(text)
        return subprocess.run([self.bin / "pent-sim", self.folder / "s.toml", "--quiet", *options],
                              capture_output=True, text=True)

    def takes(self, text):
        outcome = self.run(text, "--explain")
        return outcome.returncode == 0 or "s.toml:" not in outcome.stderr, outcome.stderr.strip()

    def defaults(self):
        moved = BODY.replace('"a"', '"b"'), HOLD.replace('"a"', '"b"')
        text = (f"[scene]\nframes = 1\n{BODY}{moved[0]}[[constraint]]\n{HOLD}"
                f"[[constraint]]\n{moved[1]}motion = {{}}\n[[obstacle]]\n{FLOOR}[contact]\n[damping]\n[sleep]\n[solver]\n[output]\n")
        outcome = self.run(text, "-o", self.folder / "run")
        if outcome.returncode != 0:
            sys.exit(outcome.stderr)
        written = (self.folder / "run/scene.toml").read_text()
        found = tomllib.loads(written)
        found["scene"]["frames"] = 100  # shortened above
        for motion in found["constraint"][1]["motion"]:
            found["constraint"][0] |= {f"motion.{key}": value for key, value in motion.items()}
        balanced = self.run(text.replace("[solver]", '[solver]\npreset = "balanced"'), "-o",
                            self.folder / "balanced")
        if balanced.returncode == 0 and (self.folder / "balanced/scene.toml").read_text() == written:
            found["solver"]["preset"] = "balanced"
        young = re.search(r"# young = (\S+), poisson = (\S+)", written)
        found["body"][0]["material"] |= {"young": float(young[1]), "poisson": float(young[2])}
        return found


def lookup(found, block, key):
    node = found[block][0] if isinstance(found[block], list) else found[block]
    if key in node:
        return node[key]
    for part in key.split("."):
        if isinstance(node, list) or not isinstance(node, dict) or part not in node:
            return None
        node = node[part]
    return node


def is_default(text, value):
    """Whether a cell of the column "default" says this value; None if it says nothing that can be compared."""
    text = re.split(r"[(;,]| \(", text)[0].strip().strip("`")
    if text == "zero":
        return value is not None and not any(value)
    if text == "none":
        return value in (None, [])
    if text in ("true", "false"):
        return value is (text == "true")
    if text.startswith('"'):
        return value == text.strip('"')
    try:
        number = float(text)
    except ValueError:
        return None
    return value is not None and abs(number - value) <= 1e-9 * abs(value)


def borders(text):
    """(value, is taken) for what a cell says of a range."""
    if match := re.search(r"(\d+)\.\.(\d+)", text):
        low, high = int(match[1]), int(match[2])
        yield from ((low, True), (high, True), (low - 1, False), (high + 1, False))
    if "-1 < nu < 1/(n-1)" in text:
        yield from ((-1, False), (0.3334, False), (-0.999, True), (0.333, True))
    if "> 0" in text:
        yield from ((0, False), (-1, False), ("1e-3", True))
    if ">= 0" in text:
        yield from ((0, True), (-1, False))
    if "in (0, 1)" in text:
        yield from ((0, False), (1, False), (0.5, True))
    words = [word for word in re.findall(r'`("[\w-]+")`', text)]
    yield from ((word, True) for word in words)
    if words:
        yield '"nothing"', False


def main():
    bin = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/dev/bin")
    text = (ROOT / "docs/simulator.md").read_text()
    differences, looked_at, seen = [], 0, {}
    with tempfile.TemporaryDirectory() as folder:
        program = Program(folder, bin.resolve())
        found = program.defaults()
        for block, key, cells in rows(text):
            seen.setdefault(block, set()).add(key.split(".")[0])
            said = is_default(cells.get("default", ""), lookup(found, block, key))
            looked_at += said is not None
            if said is False:
                differences.append(f"[{block}] {key}: docs say the default {cells['default']}, "
                                   f"the program has {lookup(found, block, key)}")
            if "required" in cells.get("default", "") or "name" == key:
                continue
            for value, expected in borders(" ".join(cells[h] for h in cells if h != "default")):
                taken, why = program.takes(scene(block, key, value))
                looked_at += 1
                if taken != expected:
                    differences.append(f"[{block}] {key} = {value}: docs say it is "
                                       f"{'taken' if expected else 'refused'}; {why or 'it is taken'}")
        for block, keys in seen.items():
            entry = found[block][0] if isinstance(found[block], list) else found[block]
            for key in sorted({name.split(".")[0] for name in entry} - keys):
                differences.append(f"[{block}] {key}: is not in docs/simulator.md")
    print("\n".join(differences) or f"docs/simulator.md: {looked_at} defaults and borders as in the program")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
