"""Prints a table of the parts, and the functions that no test called, from gcovr's JSON.

Usage: coverage_table.py COVERAGE.json [PREFIX]   with a prefix: the uncovered lines of files whose
path begins with it instead.
"""
import collections
import json
import pathlib
import sys


def counted(file):
    """Count by line number, of the lines that count."""
    return {line["line_number"]: line["count"] for line in file["lines"]
            if not line["gcovr/noncode"] and not line["gcovr/excluded"]}


def called(file, lines):
    """Whether each function was called, by the line it begins at: a template counts once."""
    functions = collections.defaultdict(bool)
    for function in file["functions"]:
        if function["lineno"] in lines:
            functions[function["lineno"]] |= function["execution_count"] > 0
    return functions


def share(values):
    return f"{100 * sum(values) / len(values):.1f}% of {len(values)}" if values else "-"


def print_table(files):
    parts = collections.defaultdict(lambda: ([], []))
    never_called = []
    for file in files:
        lines = counted(file)
        functions = called(file, lines)
        for name in (file["file"].split("/")[0], "all"):
            parts[name][0].extend(count > 0 for count in lines.values())
            parts[name][1].extend(functions.values())
        never_called += [f"{file['file']}:{line}" for line in sorted(functions) if not functions[line]]
    total = parts.pop("all")
    print(f"{'part':<12}{'lines':>20}{'functions':>20}")
    for name, (lines, functions) in [*sorted(parts.items()), ("all", total)]:
        print(f"{name:<12}{share(lines):>20}{share(functions):>20}")
    for place in never_called:
        print(f"never called: {place}")


def print_uncovered(files, prefix):
    for file in files:
        missed = sorted(line for line, count in counted(file).items() if count == 0)
        if missed and file["file"].startswith(prefix):
            text = pathlib.Path(file["file"]).read_text(encoding="utf-8").splitlines()
            print(file["file"])
            for line in missed:
                print(f"  {line:4} {text[line - 1]}")


def main():
    files = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))["files"]
    if len(sys.argv) > 2:
        print_uncovered(files, sys.argv[2])
    else:
        print_table(files)


if __name__ == "__main__":
    main()
