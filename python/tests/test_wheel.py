"""The wheel, as somebody installs it: without a net, into an environment of its own."""

import os
import pathlib
import subprocess
import sys

import pytest
from conftest import PYTHON

BUILT = pathlib.Path(os.environ.get("PENTIMENTO_LIBRARY", "none")).parents[1]

FIRST_BODY = """
import pentimento, pathlib
assert pentimento.__version__[0].isdigit(), pentimento.__version__
assert "site-packages" in pentimento.__file__, pentimento.__file__
ball = pentimento.make_mesh(sphere=2, generator="tetgen", thickness=1.0)
scene = pentimento.SceneBuilder(gravity=[0, -9.8, 0, 0], frames=3).body("ball", ball).build()
with scene.simulate() as simulation:
    simulation.step(3)
    run = scene.run("run")
    assert (run.frame(3).positions == simulation.positions()).all()
assert pentimento.render(run, size=(64, 48)).array.shape == (48, 64, 3)
"""


@pytest.mark.slow
def test_pip_installs_it_offline_and_it_can_be_moved(tmp_path):
    if not (BUILT / "plugin" / "libpent_plugin.so.2").exists():
        pytest.skip(f"{BUILT} is no folder of a build")
    plain = {key: value for key, value in os.environ.items() if not key.startswith("PENTIMENTO")}
    words = ["venv", "--system-site-packages", tmp_path / "env"]
    subprocess.run([sys.executable, "-m", *words], check=True)
    python = tmp_path / "env" / "bin" / "python"
    installed = subprocess.run(
        [python, "-m", "pip", "install", "--no-index", "--quiet", PYTHON],
        env={**plain, "PENTIMENTO_BUILD": str(BUILT)},
        capture_output=True,
        text=True,
    )
    assert installed.returncode == 0, installed.stderr
    words = [python, "-c", FIRST_BODY]
    done = subprocess.run(words, cwd=tmp_path, env=plain, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    # Elsewhere: nothing in it knows where it was.
    (package,) = (tmp_path / "env").glob("lib/python*/site-packages/pentimento")
    moved = tmp_path / "elsewhere" / "site-packages"
    moved.mkdir(parents=True)
    package.rename(moved / "pentimento")
    code = "import pentimento; print(pentimento.make_mesh(box=(1, 1, 1, 1)).cell_count)"
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env={**plain, "PYTHONPATH": str(moved)},
        capture_output=True,
        text=True,
    )
    assert done.stdout == "24\n", done.stderr


def test_a_wheel_without_a_build_is_refused_with_a_sentence(tmp_path):
    done = subprocess.run(
        [sys.executable, PYTHON / "build_backend.py", tmp_path],
        env={**os.environ, "PENTIMENTO_BUILD": str(tmp_path)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 1 and "build it by cmake --preset release" in done.stderr
