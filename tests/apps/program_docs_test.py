"""Man pages and completions have the options of the programs, and no others; bash loads them.

    program_docs_test.py SOURCE BUILD
"""

import gzip
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import unittest

SOURCE, BUILD = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
sys.path.insert(0, str(SOURCE / "apps" / "docs"))
import program_docs  # noqa: E402

PROGRAMS = sorted(path.name for path in (BUILD / "docs" / "completions").iterdir())


def said(program: str, option: str) -> str:
    command = [BUILD / "bin" / program, option]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def man_page(program: str) -> str:
    return gzip.decompress((BUILD / "docs" / "man" / f"{program}.1.gz").read_bytes()).decode()


def options_in(text: str) -> set[str]:
    """Of the help's first column, counted apart from program_docs."""
    found = re.findall(r"^ {2,6}(-\w,)?(--[a-z][\w-]*)", text, re.M)
    return {long for _, long in found}


def complete(program: str, *words: str) -> list[str]:
    """What bash offers for the last of the words."""
    script = (
        f"source {BUILD}/docs/completions/{program}\n"
        f"COMP_WORDS=({shlex.join([program, *words])}) COMP_CWORD={len(words)}\n"
        f"_{program.replace('-', '_')}\n"
        "printf '%s\\n' \"${COMPREPLY[@]}\"\n"
    )
    run = ["bash", "-u", "-c", script]
    return subprocess.run(run, check=True, capture_output=True, text=True).stdout.split()


class ProgramDocs(unittest.TestCase):
    def test_there_is_a_program(self):
        self.assertIn("pent-sim", PROGRAMS)

    def test_completion_offers_every_option_and_no_other(self):
        for program in PROGRAMS:
            with self.subTest(program):
                self.assertEqual(set(complete(program, "--")), options_in(said(program, "--help")))

    def test_a_word_is_completed_by_what_begins_so(self):
        self.assertEqual(complete("pent-sim", "--res"), ["--resume"])
        self.assertEqual(complete("pent-sim", "scene.toml", "--threads", ""), [])

    @unittest.skipUnless("pent-mesh" in PROGRAMS, "the mesher was not built")
    def test_choices_are_offered(self):
        self.assertEqual(complete("pent-mesh", "--repair", ""), ["auto", "light", "wrap", "none"])
        self.assertEqual(complete("pent-mesh", "--dim", ""), ["4", "3"])

    def test_files_are_offered_where_one_is_meant(self):
        self.assertEqual(complete("pent-sim", "-o", f"{SOURCE}/READ"), [f"{SOURCE}/README.md"])
        self.assertEqual(complete("pent-sim", f"{SOURCE}/READ"), [f"{SOURCE}/README.md"])
        self.assertEqual(complete("pent-sim", "--isa", f"{SOURCE}/READ"), [])
        if "pent-mesh" in PROGRAMS:  # --body names one of a run folder, and is no file itself
            self.assertEqual(complete("pent-mesh", "--body", f"{SOURCE}/READ"), [])
        if "pent-study" in PROGRAMS:
            self.assertEqual(
                complete("pent-study", "--write-scene", f"{SOURCE}/READ"), [f"{SOURCE}/README.md"]
            )

    def test_every_option_has_its_text_in_the_man_page(self):
        for program in PROGRAMS:
            text = man_page(program)
            listed = re.findall(r"^\.TP\n(.*)\n(.*)$", text, re.M)
            heads = "".join(head for head, _ in listed).replace("\\-", "-")
            names = set(re.findall(r"\\fB(.*?)\\fR", heads))
            with self.subTest(program):
                self.assertLessEqual(options_in(said(program, "--help")), names)
                self.assertEqual([head for head, about in listed if not about.strip()], [])
                self.assertIn(said(program, "--version").split()[1], text)

    @unittest.skipUnless("pent-mesh" in PROGRAMS, "the mesher was not built")
    def test_the_man_page_says_what_goes_with_what_behind_the_text(self):
        page = man_page("pent-mesh").replace("\\-", "-")
        heads = re.findall(r"^\.TP\n(.*)$", page, re.M)
        self.assertEqual([head for head in heads if "Needs:" in head or "Excludes:" in head], [])
        self.assertIn("Which body, of a run folder that has several (needs --space-time)\n", page)
        self.assertRegex(page, r"NUMBER above 0, default 1\\fR\n.*\(not with input\)\n")
        self.assertIn("(not with --extrude, --profile)\n", page)

    @unittest.skipUnless(shutil.which("groff"), "no groff")
    def test_groff_has_nothing_to_say(self):
        for program in PROGRAMS:
            run = ["groff", "-man", "-ww", "-Tutf8"]
            page = man_page(program)
            told = subprocess.run(run, input=page, capture_output=True, text=True).stderr
            with self.subTest(program):
                self.assertEqual(told, "")

    def test_what_looks_like_a_command_of_roff_is_text(self):
        self.assertEqual(program_docs.roff(".pent files\n'a\\b-c"), "\\&.pent files\n\\&'a\\eb\\-c")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
