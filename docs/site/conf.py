"""How Sphinx builds the site, called by scripts/site.sh on what stage.py laid out."""

import os
import pathlib
import re
import sys

ROOT = pathlib.Path(os.environ["PENT_SOURCE"])
sys.path.insert(0, str(ROOT / "python"))

project = "Pentimento"
copyright = "The Pentimento authors"
version = re.search(r"project\(pent VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
release = version

extensions = ["myst_parser", "sphinx.ext.autodoc"]
myst_heading_anchors = 4
highlight_language = "none"
autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
add_module_names = False

html_theme = "furo"
html_title = f"Pentimento {version}"
html_static_path = [str(ROOT / "docs/site/static")]
html_extra_path = [os.environ["PENT_SITE_EXTRA"]]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_theme_options = {
    "light_css_variables": {
        "color-brand-primary": "#b4501e",
        "color-brand-content": "#a04318",
        "code-font-size": "75%",  # so that lines of 98 letters fit beside the contents
    },
    "dark_css_variables": {"color-brand-primary": "#ff9559", "color-brand-content": "#ffa877"},
}


def take_arguments(_app, what, _name, _object, _options, lines):
    """Of our docstrings: "name  What it is." with two spaces, as a list of arguments."""
    if what == "module" or lines[:1] and lines[0].startswith("Alias for field number"):
        lines.clear()  # the page has its own beginning; fields have their names
    for number, line in enumerate(lines):
        if match := re.match(r"^(\w+(?:, \w+)*)  +(\S.*)", line):
            lines[number] = f":{match[1]}: {match[2]}"
        elif re.match(r"^ {6,}\S", line):  # goes on below
            lines[number] = "    " + line.strip()


def setup(app):
    """Called by Sphinx."""
    app.connect("autodoc-process-docstring", take_arguments)
