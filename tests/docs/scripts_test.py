"""Every script of scripts/ says what it does and what it takes, and does nothing else then.

    scripts_test.py SOURCE
"""

import os
import pathlib
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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
