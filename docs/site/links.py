#!/usr/bin/env python3
"""Checks that every link and anchor of README, docs/ and what is beside them leads somewhere.

    links.py [ROOT]             of the Markdown in a checkout
    links.py --site FOLDER      of a site as built, and that its pages load nothing from elsewhere

Needs no net: links to other sites are not followed. Anchors are those that GitHub and the site make
of headings.
"""

from __future__ import annotations

import html.parser
import pathlib
import re
import sys
import urllib.parse
from collections.abc import Callable

# A link or a picture, outside of code.
LINK = re.compile(r"(?P<text>!?\[(?:[^\[\]]|\[[^\]]*\]\([^)]*\))*\])\((?P<target>[^()\s]+)\)")
# Blocks and spans of code; but a span may be what a link says, whose target is none.
CODE = re.compile(
    r"(?P<linked>\[`[^`\n]*`\](?=\())|^```.*?^```[^\n]*$|^(?: {4}|\t)[^\n]*$|`[^`\n]*`", re.M | re.S
)


def outside_code(text: str, change: Callable[[str], str]) -> str:
    """The text with everything that is not code changed."""
    parts, end = [], 0
    for match in CODE.finditer(text):
        if not match["linked"]:
            parts += [change(text[end : match.start()]), match[0]]
            end = match.end()
    return "".join(parts) + change(text[end:])


def anchor(heading: str) -> str:
    """What a heading is called in addresses."""
    words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", words).replace(" ", "-")


def anchors(page: pathlib.Path) -> set[str]:
    """All that a link may have behind # in a page."""
    text = re.sub(r"^```.*?^```[^\n]*$", "", page.read_text(), flags=re.M | re.S)
    found: set[str] = set()
    for heading in re.findall(r"^#{1,6} +(.*?) *#*$", text, re.M):
        name, count = anchor(heading), 0
        while (name if count == 0 else f"{name}-{count}") in found:
            count += 1
        found.add(name if count == 0 else f"{name}-{count}")
    return found


def links(page: pathlib.Path) -> list[tuple[int, str]]:
    """The links of a page, each with the number of its line."""
    text = page.read_text()
    for match in CODE.finditer(text):
        if not match["linked"]:
            blank = re.sub(r"[^\n]", " ", match[0])
            text = text[: match.start()] + blank + text[match.end() :]
    found = [(match.start(), match["target"]) for match in LINK.finditer(text)]
    # In a picture that is a link, too.
    for outer in re.finditer(r"\[!\[[^\]]*\]\(([^()\s]+)\)\]", text):
        found.append((outer.start(), outer[1]))
    return [(text.count("\n", 0, start) + 1, target) for start, target in found]


def broken_in_markdown(root: pathlib.Path) -> list[str]:
    """A line for each link that leads nowhere."""
    pages = [root / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
    pages += [page for page in sorted((root / "docs").rglob("*.md")) if "site" not in page.parts]
    broken = []
    for page in pages:
        for line, target in links(page):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, name = urllib.parse.unquote(target).partition("#")
            there = (page.parent / path).resolve() if path else page
            where = f"{page.relative_to(root)}:{line}: {target}"
            if not there.exists() or not there.is_relative_to(root.resolve()):
                broken.append(f"{where}: no such file in the repository")
            elif name and (there.suffix != ".md" or name not in anchors(there)):
                broken.append(f"{where}: no heading there is called so")
    return broken


class Page(html.parser.HTMLParser):
    """What a page of HTML points to, loads and can be pointed at."""

    def __init__(self, path: pathlib.Path) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.loaded: list[str] = []
        self.names = {"", "top"}
        self.feed(path.read_text())

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = dict(attributes)
        self.names |= {given.get("id") or "", given.get("name") or ""}
        target = given.get("href") or given.get("src")
        if target:
            self.targets.append(target)
            if tag not in ("a", "area") and given.get("rel") not in ("canonical", "author"):
                self.loaded.append(target)


def broken_in_site(folder: pathlib.Path) -> list[str]:
    """The same of pages of HTML; and what they load from elsewhere."""
    # Pages of other generators link their own pages only.
    paths = [path for path in sorted(folder.rglob("*.html")) if "page" not in path.parts]
    pages = {path: Page(path) for path in paths if "cpp" not in path.relative_to(folder).parts}
    broken = []
    for path, page in pages.items():
        for target in page.targets:
            address = urllib.parse.urlsplit(target)
            where = f"{path.relative_to(folder)}: {target}"
            if address.scheme or address.netloc:
                if target in page.loaded and address.scheme != "data":
                    broken.append(f"{where}: loaded from another place")
                continue
            name = urllib.parse.unquote(address.path)
            there = (path.parent / name).resolve() if name else path
            if name.startswith("/") or not there.exists():
                broken.append(f"{where}: no such file, or not a relative link")
            elif address.fragment and there in pages:
                if urllib.parse.unquote(address.fragment) not in pages[there].names:
                    broken.append(f"{where}: nothing there is called so")
    for path in sorted(folder.rglob("*.css")):
        for target in re.findall(r"url\([\"']?([^\"')]+)", path.read_text()):
            name = target.partition("#")[0].partition("?")[0]
            if not target.startswith(("data:", "#")) and not (path.parent / name).exists():
                broken.append(f"{path.relative_to(folder)}: {target}: no such file, or elsewhere")
    return broken


def main() -> int:
    if sys.argv[1:2] == ["--site"]:
        broken = broken_in_site(pathlib.Path(sys.argv[2]).resolve())
    else:
        root = sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2]
        broken = broken_in_markdown(pathlib.Path(root).resolve())
    print("\n".join(broken) if broken else "links: every one leads somewhere")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
