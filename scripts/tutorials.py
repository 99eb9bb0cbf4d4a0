#!/usr/bin/env python3
"""Runs the tutorials, and README: writes the files that they show, and runs every command.

    tutorials.py [NAME...]           all of docs/tutorials, or these, README too; into
                                     out/tutorials/NAME; the pictures that a tutorial shows are
                                     copied to where it shows them from
    tutorials.py --small NAME...     the same with small bodies and few frames, in seconds, into a
                                     temporary folder; no picture is copied. The tests do this

    --bin FOLDER       where the programs are; default: build/release/bin
    --library FILE     of the Python package; default: build/release/plugin/libpent_plugin.so

A block of code of a page is a file if it begins with a line "# NAME", else, as sh, commands.
"<!-- small: OLD => NEW -->" says what to write in place of what where all shall be small.
"""

from __future__ import annotations

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = ROOT / "docs" / "tutorials"


def blocks(text: str) -> list[tuple[str, str]]:
    """The blocks of code of a page: language and text."""
    return re.findall(r"^```(\w+)\n(.*?)^```$", text, re.M | re.S)


def pictures(text: str) -> list[str]:
    """The pictures that a page shows."""
    return re.findall(r"!\[[^\]]*\]\((\S+)\)", text)


def smaller(text: str) -> str:
    """The page with small bodies and few frames; each of its words has to be in it."""
    for old, new in re.findall(r"<!-- small: (.*?) => (.*?) -->", text):
        if text.count(old) < 2:  # once in the comment itself
            raise SystemExit(f"small: {old}: not in the page")
        text = text.replace(old, new)
    return text


def run_page(text: str, folder: pathlib.Path, environment: dict[str, str]) -> None:
    """Writes the files and runs the commands, in their order; ends at the first that fails."""
    for language, code in blocks(text):
        name = re.match(r"# ([\w.-]+)\n", code)
        if name:
            (folder / name[1]).write_text(code)
        elif language == "sh":
            print(code, end="", flush=True)
            run = ["bash", "-euo", "pipefail", "-c", code]
            subprocess.run(run, cwd=folder, env=environment, check=True)
        elif language != "python":  # examples of Python are tests of its package
            raise SystemExit(f"a block of {language} is neither a file nor commands:\n{code}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*")
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/release/bin")
    library = ROOT / "build/release/plugin/libpent_plugin.so"
    parser.add_argument("--library", type=pathlib.Path, default=library)
    given = parser.parse_args()
    environment = os.environ | {
        "PATH": os.pathsep.join(
            [str(given.bin.resolve()), os.path.dirname(sys.executable), os.environ["PATH"]]
        ),
        "PYTHONPATH": str(ROOT / "python"),
        "PENTIMENTO_BIN": str(given.bin.resolve()),
        "PENTIMENTO_LIBRARY": str(given.library.resolve()),
    }
    for name in given.names or sorted(path.stem for path in PAGES.glob("*.md")):
        page = ROOT / "README.md" if name == "README" else PAGES / f"{name}.md"
        text = page.read_text()
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            if not given.small:
                folder = ROOT / "out" / "tutorials" / name
                shutil.rmtree(folder, ignore_errors=True)
                folder.mkdir(parents=True)
            (folder / "data").symlink_to(ROOT / "data")
            try:
                run_page(smaller(text) if given.small else text, folder, environment)
            except subprocess.CalledProcessError as error:
                print(f"tutorials: {name}: failed: {error.cmd[-1]}", file=sys.stderr)
                return 1
            for picture in pictures(text) if page.parent == PAGES else []:
                made = folder / pathlib.Path(picture).name
                if not made.exists():
                    print(f"tutorials: {name}: no command makes {made.name}", file=sys.stderr)
                    return 1
                if not given.small:
                    target = (PAGES / picture).resolve()
                    target.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(made, target)
    return 0


if __name__ == "__main__":
    sys.exit(main())
