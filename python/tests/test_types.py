"""The types hold, as mypy --strict sees them."""

import importlib.util
import subprocess
import sys

import pytest
from conftest import PYTHON


@pytest.mark.slow
def test_types_hold():
    if importlib.util.find_spec("mypy") is None:
        pytest.skip("this Python has no mypy: scripts/setup.sh --python")
    words = [sys.executable, "-m", "mypy", "--strict", "--cache-dir=/dev/null", "pentimento"]
    done = subprocess.run(words, cwd=PYTHON, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
