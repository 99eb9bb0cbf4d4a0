"""Every script of scripts/ says what it does and what it takes, and does nothing else then; and
commands in pages may be copied as they are.

    scripts_test.py SOURCE
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1])
ALONE = {"study_slurm.sh"}  # installed without the others


def scripts() -> list[pathlib.Path]:
    """Those that are run; what they share is not."""
    every = sorted((SOURCE / "scripts").glob("*.sh"))
    return [path for path in every if path.read_text().startswith("#!")]


def comment_of(script: pathlib.Path) -> list[str]:
    """The comment at its beginning, taken apart by lines."""
    lines = script.read_text().splitlines()[1:]
    end = next(number for number, line in enumerate(lines) if not line.startswith("#"))
    return [line.removeprefix("#").removeprefix(" ") for line in lines[:end]]


class Scripts(unittest.TestCase):
    def test_there_are_some(self):
        self.assertIn("demo.sh", [path.name for path in scripts()])

    def test_each_looks_for_help_before_anything_else(self):
        for script in scripts():
            body = script.read_text().splitlines()[1 + len(comment_of(script)) :]
            with self.subTest(script.name):
                if script.name not in ALONE:
                    self.assertEqual(body[:2], ["set -euo pipefail", '. "$(dirname "$0")/help.sh"'])

    def test_help_is_the_comment_at_the_beginning(self):
        for script in scripts():
            if script.name not in ALONE and "help.sh" not in script.read_text():
                continue  # the test above says so; this one would run it
            for words in (["--help"], ["-h"], ["some", "--help"]):
                if script.name in ALONE and words[0] == "some":
                    continue  # what follows a study is for sbatch
                with self.subTest(script.name), tempfile.TemporaryDirectory() as place:
                    line = ["bash", script, *words]
                    run = subprocess.run(line, cwd=place, capture_output=True, text=True)
                    self.assertEqual((run.returncode, run.stderr), (0, ""))
                    self.assertEqual(run.stdout.splitlines(), comment_of(script))
                    self.assertEqual(os.listdir(place), [])


def commands_of(page: pathlib.Path) -> list[str]:
    """Its indented lines of commands: blocks between fences are run by other tests."""
    plain = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.M | re.S)
    return re.findall(r"^    ((?:pent-|scripts/|mpirun |python3 |cmake ).*)$", plain, re.M)


class Pages(unittest.TestCase):
    def test_there_are_commands_in_some(self):
        self.assertGreater(len(commands_of(SOURCE / "docs" / "mesher.md")), 40)

    def test_what_is_said_behind_a_command_is_a_comment(self):
        for page in [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md"))]:
            for line in commands_of(page):
                arguments = line.partition("#")[0].strip().partition(" ")[2].strip()
                with self.subTest(page.name, line=line):
                    self.assertIsNone(re.search(r" {2}", arguments))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
