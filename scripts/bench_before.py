#!/usr/bin/env python3
"""Measures the kernels and steps of scripts/bench.sh beside those of another build.

    scripts/bench_before.py OTHER/bench_simulator [--rounds 5] [--threads 2] [--write FILE.md]

Times of a machine that others share differ by a tenth or more from minute to minute; so the two programs take turns,
round by round, and what counts is the ratio of two that came one after the other: its median, and quartiles. The
cases are those that both have by the same name. Another commit is built in a checkout of its own:

    cmake -S . -B build/bench -DCMAKE_BUILD_TYPE=Release -DPENT_BUILD_BENCHMARKS=ON -DPENT_BUILD_TESTS=OFF
    cmake --build build/bench --target bench_simulator
"""

import argparse
import os
import statistics
import subprocess
import sys
from pathlib import Path

UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}


def seconds_of(text):
    """Seconds of a time as the tables write it, or None."""
    number, _, unit = text.partition(" ")
    try:
        return float(number) * UNITS[unit]
    except (KeyError, ValueError):
        return None


def cases_of(told):
    """Seconds of each case by its name and number of threads."""
    cases = {}
    for line in told.splitlines():
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if len(cells) > 2 and (seconds := seconds_of(cells[2])) is not None:
            cases[cells[0], cells[1]] = seconds
    return cases


def measured(program, threads):
    """The cases of one round of a program; ends with its message if it fails."""
    try:
        done = subprocess.run([program, "--threads", str(threads), "--no-growth", "--rounds", "1"], check=False, capture_output=True, text=True)
    except OSError as error:
        sys.exit(f"bench_before: {program} does not run: {error.strerror}")
    if done.returncode != 0:
        sys.exit(f"bench_before: {program} ended with {done.returncode}: {done.stderr.strip()}")
    return cases_of(done.stdout)


def rows_of(options):
    """The lines of the table."""
    rounds = [(measured(options.before, options.threads), measured(options.program, options.threads)) for _ in range(options.rounds)]
    names = [name for name in rounds[0][1] if name in rounds[0][0]]
    if not names:
        sys.exit("bench_before: the programs have no case in common")
    yield "| what | threads | before, ms | now, ms | now / before | quartiles |"
    yield "| --- | --- | --- | --- | --- | --- |"
    for name in names:
        before, now = ([cases[name] for cases in side] for side in zip(*rounds, strict=True))
        ratios = [b / a for a, b in zip(before, now, strict=True)]
        low, middle, high = statistics.quantiles(ratios, n=4, method="inclusive") if len(ratios) > 1 else 3 * ratios
        yield (
            f"| {name[0]} | {name[1]} | {1e3 * statistics.median(before):.3g} | {1e3 * statistics.median(now):.3g} "
            f"| {middle:.2f} | {low:.2f} to {high:.2f} |"
        )


def parsed():
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=Path, help="the bench_simulator to compare with")
    parser.add_argument("--program", type=Path, default=Path("build/bench/bin/bench_simulator"), help="ours, default %(default)s")
    parser.add_argument("--rounds", type=int, default=5, help="default %(default)s")
    parser.add_argument("--threads", type=int, default=os.cpu_count(), help="default: the number of cores")
    parser.add_argument("--write", type=Path, help="a file to append the table to")
    options = parser.parse_args()
    for program in (options.before, options.program):
        if not program.is_file():
            sys.exit(f"bench_before: there is no program {program}: build the target bench_simulator")
    options.before, options.program = options.before.resolve(), options.program.resolve()
    if options.rounds < 1 or options.threads < 1:
        sys.exit("bench_before: expected at least 1 round and 1 thread")
    return options


def main():
    """Prints the table, and appends it where it is asked for."""
    options = parsed()
    rows = list(rows_of(options))
    print("\n".join(rows))
    if options.write:
        with options.write.open("a", encoding="utf-8") as file:
            file.write("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
