"""Links that lead nowhere are found, those that lead somewhere are not; the site is laid out whole.

    site_test.py SOURCE
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(SOURCE / "docs" / "site"))
import links  # noqa: E402
import stage  # noqa: E402


class Repository:
    """A folder with the pages that a test wants."""

    def __init__(self, root: str) -> None:
        self.root = pathlib.Path(root)
        for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md"):
            self.write(name, "# Title\n")
        headings = ("# The page", "## Two words", "## Two words", "## `code`, and more!")
        self.write("docs/a.md", "\n\n".join(headings) + "\n")

    def write(self, name: str, text: str) -> None:
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)


class Markdown(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.made = Repository(folder.name)

    def broken(self, text: str, name: str = "README.md") -> list[str]:
        self.made.write(name, text)
        return links.broken_in_markdown(self.made.root)

    def test_links_to_pages_headings_and_other_sites_are_good(self):
        good = (
            "[a](docs/a.md) [b](docs/a.md#two-words) [c](docs/a.md#two-words-1) [d](#here)\n"
            "[`code`](docs/a.md#code-and-more) [e](https://example.org/nothing)\n\n# Here\n"
        )
        self.assertEqual(self.broken(good), [])

    def test_a_link_to_no_file_is_found_with_its_line(self):
        self.assertEqual(
            self.broken("# T\n\n[a](docs/b.md)\n"),
            ["README.md:3: docs/b.md: no such file in the repository"],
        )

    def test_a_missing_picture_and_one_within_a_link_are_found(self):
        self.assertEqual(len(self.broken("![a](no.png) and [![a](gone.png)](docs/a.md)\n")), 2)

    def test_a_link_to_no_heading_is_found(self):
        for target in ("docs/a.md#three-words", "docs/a.md#two-words-2", "#nowhere"):
            found = self.broken(f"[a]({target})\n")
            self.assertEqual(found, [f"README.md:1: {target}: no heading there is called so"])

    def test_a_heading_within_code_is_none(self):
        self.assertEqual(len(self.broken("[a](#b)\n\n```sh\n# b\n```\n")), 1)

    def test_a_link_out_of_the_repository_is_found(self):
        self.assertEqual(len(self.broken("[a](../../../../etc/passwd)\n", "docs/b.md")), 1)

    def test_what_looks_like_a_link_in_code_is_none(self):
        self.assertEqual(self.broken("`[&](x)`\n\n    [a](b)\n\n```\n[a](b)\n```\n"), [])

    def test_links_named_in_code_are_looked_at(self):
        self.assertEqual(len(self.broken("[`b`](b.md), `c` and [`d`](d.md)\n")), 2)

    def test_code_stays_as_it_is_where_links_are_turned(self):
        text = "[`a`](a.md) and `[b](c)`\n\n    [d](e)\n"
        turned = links.outside_code(text, lambda part: links.LINK.sub("X", part))
        self.assertEqual(turned, "X and `[b](c)`\n\n    [d](e)\n")


class Site(unittest.TestCase):
    def broken(self, body: str) -> list[str]:
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "b.html").write_text("<h1 id='top-of-b'>b</h1>")
            (root / "a.html").write_text(f"<html><body id='x'>{body}</body></html>")
            return links.broken_in_site(root)

    def test_good_ones(self):
        self.assertEqual(self.broken("<a href='b.html#top-of-b'>b</a><a href='#x'></a>"), [])
        self.assertEqual(self.broken("<a href='https://example.org'>there</a>"), [])

    def test_bad_ones_are_found(self):
        for bad in (
            "<a href='c.html'>c</a>",
            "<a href='b.html#y'>b</a>",
            "<a href='/b.html'>not from a folder within a host</a>",
            "<img src='c.png'>",
            "<script src='https://example.org/a.js'></script>",
            "<link rel='stylesheet' href='https://example.org/fonts.css'>",
        ):
            with self.subTest(bad):
                self.assertEqual(len(self.broken(bad)), 1)


    def test_what_styles_load_from_elsewhere_is_found(self):
        for target, count in (("a.png", 1), ("/b.html", 1), ("b.html", 0), ("data:image/png,x", 0)):
            with tempfile.TemporaryDirectory() as folder, self.subTest(target):
                (pathlib.Path(folder) / "b.html").write_text("")
                (pathlib.Path(folder) / "a.css").write_text(f"p {{ background: url({target}) }}")
                self.assertEqual(len(links.broken_in_site(pathlib.Path(folder))), count)


WRITTEN_BY_SCRIPTS = {"accuracy.md", "paper-table.md", "stability.md"}  # from templates of theirs


class Pages(unittest.TestCase):
    pages = [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md"]
    pages += sorted(page for page in SOURCE.glob("docs/**/*.md") if "site" not in page.parts)

    def test_each_says_first_who_it_is_for(self):
        for page in self.pages[1:]:
            text = re.sub(r"<!--.*?-->", "", page.read_text())
            first = text.partition("\n")[2].lstrip()
            with self.subTest(page.name):
                if page.name not in WRITTEN_BY_SCRIPTS:
                    self.assertRegex(first, r"^\*[A-Z]")

    def test_rows_of_tables_have_as_many_cells_as_their_heads(self):
        for page in self.pages:
            head = None
            for number, line in enumerate(page.read_text().splitlines(), 1):
                is_row = line.lstrip().startswith("| ")
                cells = len(re.findall(r"(?<!\\)\|", line))
                head = (cells if head is None else head) if is_row else None
                with self.subTest(f"{page.name}:{number}"):
                    self.assertEqual(head or cells, cells)


class Stage(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        command = [sys.executable, SOURCE / "docs" / "site" / "stage.py", self.folder / "site"]
        subprocess.run(command, check=True)

    def test_every_page_of_docs_is_in_the_contents(self):
        contents = (SOURCE / "docs" / "site" / "contents.md").read_text()
        for page in SOURCE.glob("docs/**/*.md"):
            if "site" not in page.parts:
                name = str(page.relative_to(SOURCE / "docs").with_suffix(""))
                self.assertRegex(contents, rf"(?m)^(.* <)?{re.escape(name)}>?$")

    def test_every_link_of_what_is_laid_out_leads_to_a_file(self):
        pages = sorted((self.folder / "site").rglob("*.md"))
        self.assertGreater(len(pages), 20)
        for page in pages:
            for line, target in links.links(page):
                path = target.partition("#")[0]
                if path and ":" not in path:
                    self.assertTrue((page.parent / path).exists(), f"{page}:{line}: {target}")

    def test_readme_is_the_first_page(self):
        self.assertIn("# Pentimento", (self.folder / "site" / "index.md").read_text())

    def test_files_of_the_source_are_shown(self):
        shown = stage.Site(self.folder / "other").show("format/include/pent/parallel.h")
        self.assertEqual(shown, "files/format/include/pent/parallel.h.md")
        self.assertIn("literalinclude", (self.folder / "other" / shown).read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
