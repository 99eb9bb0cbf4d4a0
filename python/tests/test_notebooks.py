"""The notebooks run to their ends."""

import importlib.util
import os
import pathlib
import subprocess
import sys

import pytest
from conftest import PYTHON


NOTEBOOKS = sorted((PYTHON / "notebooks").glob("*.ipynb"))


@pytest.mark.slow
@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_to_its_end(notebook: pathlib.Path, tmp_path):
    if any(importlib.util.find_spec(name) is None for name in ("nbconvert", "ipykernel")):
        pytest.skip("this Python has no nbconvert and no ipykernel: scripts/setup.sh --python")
    copy = tmp_path / notebook.name
    copy.write_bytes(notebook.read_bytes())
    words = ["jupyter", "nbconvert", "--to", "html", "--execute", copy, "--log-level", "ERROR"]
    paths = os.pathsep.join(filter(None, [str(PYTHON), os.environ.get("PYTHONPATH")]))
    done = subprocess.run(
        [sys.executable, "-m", *words],
        env={**os.environ, "PYTHONPATH": paths},
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    page = copy.with_suffix(".html").read_text()
    assert "data:image/png;base64," in page
