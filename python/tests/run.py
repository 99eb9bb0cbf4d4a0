"""Runs the tests, or says loudly that it cannot: 77 then, which ctest takes for skipped.

run.py [--all] [ARGUMENTS FOR PYTEST]    --all: also what takes long (types, wheel, notebooks)
"""

import importlib.util
import pathlib
import sys

missing = [name for name in ("numpy", "pytest") if importlib.util.find_spec(name) is None]
if missing:
    print(f"SKIPPED: this Python has no {' and no '.join(missing)}: scripts/setup.sh --python")
    sys.exit(77)

import pytest  # noqa: E402

here = pathlib.Path(__file__).resolve().parent
arguments = sys.argv[1:]
chosen = [] if "--all" in arguments else ["-m", "not slow"]
arguments = [word for word in arguments if word != "--all"] or [str(here)]
plain = ["-q", "-p", "no:cacheprovider", "--rootdir", str(here.parent)]
sys.exit(pytest.main([*plain, *chosen, *arguments]))
