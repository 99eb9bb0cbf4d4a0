#!/usr/bin/env python3
"""Lays out what Sphinx reads: README, docs/ and what is beside them, as pages of one folder.

    stage.py FOLDER

README becomes the first page. A link to another page stays one; a link to any other file of the
repository leads to a page that shows it.
"""

from __future__ import annotations

import os
import pathlib
import re
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE))
from links import LINK, outside_code  # noqa: E402

BESIDE = {
    "README.md": "index.md",
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
}
LANGUAGES = {".h": "cpp", ".cpp": "cpp", ".c": "c", ".py": "python", ".sh": "bash", ".toml": "toml"}
IMAGES = {".gif", ".jpg", ".png", ".svg", ".webp"}


class Site:
    """The folder that is laid out."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.folder = folder
        self.pages = dict(BESIDE)
        for page in sorted((ROOT / "docs").rglob("*.md")):
            if HERE not in page.parents:
                self.pages[str(page.relative_to(ROOT))] = str(page.relative_to(ROOT / "docs"))

    def write(self, name: str, text: str) -> None:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def show(self, name: str) -> str:
        """The page that shows a file, or lists a folder, of the repository."""
        page = f"files/{name.rstrip('/')}.md"
        if (self.folder / page).exists():
            return page
        title = f"---\norphan: true\n---\n\n# {name}\n\n"
        self.write(page, title)  # a folder's files may be shown by now
        if (ROOT / name).is_dir():
            inside = [path for path in sorted((ROOT / name).rglob("*")) if path.is_file()]
            names = [str(path.relative_to(ROOT)) for path in inside if path.suffix != ".pyc"]
            listed = "".join(f"- [{file}]({self.link(page, file)})\n" for file in names)
            self.write(page, title + listed)
        elif (ROOT / name).suffix == ".ipynb" or (ROOT / name).stat().st_size > 200_000:
            shutil.copyfile(ROOT / name, (self.folder / page).with_suffix(".copy"))
            self.write(page, f"{title}{{download}}`{name} <{pathlib.Path(name).name}.copy>`\n")
        else:
            language = LANGUAGES.get(pathlib.Path(name).suffix, "text")
            path = os.path.relpath(ROOT / name, (self.folder / page).parent)
            self.write(page, f"{title}```{{literalinclude}} {path}\n:language: {language}\n```\n")
        return page

    def link(self, page: str, name: str) -> str:
        """From a page to a file of the repository."""
        if pathlib.Path(name).suffix in IMAGES:
            target = name.removeprefix("docs/")
            (self.folder / target).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, self.folder / target)
        else:
            target = self.pages.get(name) or self.show(name)
        return os.path.relpath(target, os.path.dirname(page) or ".")

    def stage(self, name: str) -> None:
        """A page of Markdown, its links turned."""
        page = self.pages[name]

        def turned(match: re.Match[str]) -> str:
            path, mark, anchor = match["target"].partition("#")
            if not path or re.match(r"[a-z]+:", path):
                return match[0]
            target = os.path.normpath(os.path.join(os.path.dirname(name), path))
            return f"{match['text']}({self.link(page, target)}{mark}{anchor})"

        text = outside_code((ROOT / name).read_text(), lambda part: LINK.sub(turned, part))
        if page == "index.md":
            text += "\n" + (HERE / "contents.md").read_text()
        self.write(page, text)


def try_page() -> str:
    """The page with viewer and playground in it, as far as scripts/web.sh built them."""
    text = (HERE / "try.md").read_text()
    if not (ROOT / "web/dist/index.html").exists():
        return text + "This site was built without them: `scripts/web.sh` makes them.\n"
    address = "page/index.html"
    links = f'<a href="{address}">The viewer in a page of its own</a>'
    if (ROOT / "web/dist/playground.js").exists():
        address += "?play=octopus"
        links += f' · <a href="{address}">the playground</a>'
    frame = f'<iframe class="page" src="{address}" title="Pentimento" loading="lazy"></iframe>'
    return f"{text}```{{raw}} html\n{frame}\n<p>{links}</p>\n```\n"


def main() -> None:
    folder = pathlib.Path(sys.argv[1]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    site = Site(folder)
    for name in site.pages:
        site.stage(name)
    site.write("try.md", try_page())
    for extra in ("conf.py", "api.md", "reference-cpp.md"):
        shutil.copyfile(HERE / extra, folder / extra)


if __name__ == "__main__":
    main()
