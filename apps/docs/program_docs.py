#!/usr/bin/env python3
"""Makes the man page and the bash completion of a program from what it prints for --help.

    program_docs.py PROGRAM NAME.1.gz COMPLETION

Nothing is written by hand, so that neither can have an option that is not there.
"""

from __future__ import annotations

import dataclasses
import gzip
import pathlib
import re
import subprocess
import sys


@dataclasses.dataclass
class Option:
    """A line of --help: an option with its spellings, or an argument."""

    names: list[str]  # as ["-o", "--output"]
    value: str  # what stands behind it, as "FILE"; "" for a flag
    text: str
    section: str
    company: str = ""  # what it goes with and what not, as " (needs --box)"


@dataclasses.dataclass
class Help:
    """What a program prints for --help."""

    name: str
    version: str
    about: str
    usage: str
    options: list[Option]
    arguments: list[Option]
    example: str


HEADING = re.compile(r"^ *(?:(\w[\w ]*):|\[Option Group: (.*)\])$")
ENTRY = re.compile(r"^( +)((?:-\w,)?--?[a-z][\w-]*|[a-z][\w-]*)(?: +(.*))?$")
NOTES = re.compile(r" ?REQUIRED(?= |$)")
COMPANY = re.compile(r" ?\b(Needs|Excludes):((?: (?!Needs:|Excludes:)[\w-]+)+)")
NUMBER = re.compile(r"(INT|UINT|FLOAT)\b(.*?)(?: \[(.*)\])?$")
CONTINUED = re.compile(r"^ {28,}\S")
COLUMN = 28  # where texts begin behind the indent; those without room in the line below


def entry_of(line: str, has_text: bool, section: str) -> Option | None:
    """The option or argument that a line of --help begins, with or without its text."""
    match = ENTRY.match(line)
    if match is None:
        return None
    column = len(match[1]) + COLUMN if has_text else len(line)
    head, text = line[:column], line[column:]
    names, _, value = head.strip().partition(" ")
    others = [(kind, names.split()) for kind, names in COMPANY.findall(value)]
    company = [
        ("needs " if kind == "Needs" else "not with ") + ", ".join(names) for kind, names in others
    ]
    value = NOTES.sub("", COMPANY.sub("", value)).strip()
    if number := NUMBER.match(value):  # as "INT from 1 to 9 [4]"
        kind = "INTEGER" if "INT" in number[1] else "NUMBER"
        value = kind + number[2] + (f", default {number[3]}" if number[3] else "")
    section = section if names[0] == "-" else "Arguments"
    told = f" ({'; '.join(company)})" if company else ""
    return Option(names.split(","), value, text, section, told)


def parse(name: str, text: str, version: str) -> Help:
    """Takes the text apart, which CLI11 lays out: headings, and entries further in."""
    usage = re.search(r"^Usage: (.*)$", text, re.M)
    about, rest = text[: usage.start()].strip(), text[usage.end() :]
    rest, _, example = rest.partition("\nExample:\n")
    found = Help(name, version, about, usage[1], [], [], example.rstrip())
    section, entry = "Options", None
    lines = rest.splitlines()
    for line, below in zip(lines, [*lines[1:], ""]):
        heading = HEADING.match(line)
        if heading:
            is_within = line[0] == " "  # "  Options:" of a group
            section, entry = section if is_within else heading[1] or heading[2], None
        elif entry is not None and CONTINUED.match(line):
            entry.text = f"{entry.text} {line.strip()}".strip()
        elif entry := entry_of(line, not CONTINUED.match(below), section):
            (found.options if entry.names[0][0] == "-" else found.arguments).append(entry)
    return found


def roff(text: str) -> str:
    """Text for a man page: nothing of it is taken for a command."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^(?=[.'])", r"\\&", text, flags=re.M)


def man_page(help: Help) -> str:
    """The page of section 1."""
    short = help.about.split(".")[0].split(":")[0].split(";")[0]
    lines = [
        f'.TH {help.name.upper()} 1 "" "Pentimento {help.version}" "User Commands"',
        f".SH NAME\n{roff(help.name)} \\- {roff(short[0].lower() + short[1:])}",
        f".SH SYNOPSIS\n.B {roff(help.usage)}",
        f".SH DESCRIPTION\n{roff(help.about)}",
    ]
    section = ""
    for option in help.arguments + help.options:
        if option.section != section:
            section = option.section
            lines.append(f".SH {section.upper()}")
        names = ", ".join(rf"\fB{roff(spelled)}\fR" for spelled in option.names)
        value = rf" \fI{roff(option.value)}\fR" if option.value else ""
        lines.append(f".TP\n{names}{value}\n{roff(option.text + option.company)}")
    lines.append(f".SH EXAMPLE\n.nf\n{roff(help.example)}\n.fi")
    lines.append(".SH EXIT STATUS\n0 finished, 1 refused, 2 wrong usage, 3 stopped or diverged")
    return "\n".join(lines) + "\n"


def choices(option: Option) -> list[str]:
    """The words that an option takes, if it takes but these."""
    words = re.match(r"[\w-]+(\|[\w-]+)+", option.value)
    return words[0].split("|") if words else []


def takes_file(option: Option) -> bool:
    """Whether what stands behind an option is the name of a file or folder."""
    return re.match(r"(FILE|OUT|RUN|PAGE)\b", option.value) is not None


def completion(help: Help) -> str:
    """A script that bash-completion loads when the program's name is followed by a tab."""
    function = "_" + help.name.replace("-", "_")
    words = " ".join(spelled for option in help.options for spelled in option.names)
    cases = []
    for option in help.options:
        pattern = "|".join(option.names)
        if choices(option):
            cases.append(f"{pattern}) words='{' '.join(choices(option))}' ;;")
        elif takes_file(option):
            cases.append(f"{pattern}) words='' ;;")
        elif option.value:
            cases.append(f"{pattern}) return ;;  # {option.value}")
    listed = "\n        ".join(cases)
    return f"""# Bash completion of {help.name}, made from its --help.
{function}() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} words=''
    COMPREPLY=()
    case ${{COMP_WORDS[COMP_CWORD - 1]}} in
        {listed}
        *) [[ $word != -* ]] || words='{words}' ;;
    esac
    if [ -n "$words" ]; then
        mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
    else
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -f -- "$word")
    fi
}}
complete -F {function} {help.name}
"""


def help_of(program: str) -> Help:
    """Asks the program."""

    def said(option: str) -> str:
        return subprocess.run(
            [program, option], check=True, capture_output=True, text=True
        ).stdout

    name = pathlib.Path(program).name
    return parse(name, said("--help"), said("--version").split("\n")[0].removeprefix(f"{name} "))


def main() -> None:
    help = help_of(sys.argv[1])
    page = gzip.compress(man_page(help).encode(), 9, mtime=0)  # the same bytes at any time
    pathlib.Path(sys.argv[2]).write_bytes(page)
    pathlib.Path(sys.argv[3]).write_text(completion(help))


if __name__ == "__main__":
    main()
