"""Ctrl-C stops between two steps; others run meanwhile."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import pentimento
from pentimento import _programs


@pytest.fixture(scope="module")
def slow(tmp_path_factory):
    """A scene whose steps take long enough for something to happen meanwhile."""
    mesh = pentimento.make_mesh(box=(6, 6, 6, 6))
    return pentimento.SceneBuilder(gravity=[0, -9, 0, 0], frames=3000).body("a", mesh).build()


@pytest.fixture(autouse=True)
def hears_ctrl_c():
    """As at a terminal: shells have SIGINT ignored in the background, and Python leaves it so."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupt_soon(seconds: float) -> threading.Thread:
    def interrupt():
        time.sleep(seconds)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    return thread


def test_ctrl_c_stops_between_two_steps(slow):
    with slow.simulate(threads=1) as simulation, slow.simulate(threads=1) as twin:
        thread = interrupt_soon(0.2)
        with pytest.raises(KeyboardInterrupt):
            simulation.step(10**6)
        thread.join()
        steps = round(simulation.time / simulation.time_step)
        assert steps > 0
        twin.step(steps)
        np.testing.assert_array_equal(simulation.positions(), twin.positions())
        simulation.step()


def test_other_threads_run_during_a_step(slow):
    ticks = 0
    done = threading.Event()

    def count():
        nonlocal ticks
        while not done.is_set():
            ticks += 1
            time.sleep(0.0005)

    with slow.simulate(threads=1) as simulation:
        thread = threading.Thread(target=count)
        thread.start()
        begin = time.perf_counter()
        during = 0
        while time.perf_counter() - begin < 0.3:
            before = ticks
            report = simulation.step()
            during += ticks - before if report.seconds > 0.002 else 0
        done.set()
        thread.join()
    assert during > 0


LONG_RUN = """
import pentimento
mesh = pentimento.make_mesh(box=(6, 6, 6, 6))
scene = pentimento.SceneBuilder(gravity=[0, -9, 0, 0], frames=3000).body("a", mesh).build()
try:
    scene.run("run", threads=1)
except KeyboardInterrupt:
    print("interrupted")
"""


# As a terminal does it: everybody in the group gets the signal.
def test_ctrl_c_ends_a_program_and_the_run_goes_on_later(tmp_path):
    words = [sys.executable, "-c", LONG_RUN]
    paths = os.pathsep.join(sys.path)
    process = subprocess.Popen(
        words,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": paths},
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    while not (tmp_path / "run" / "frames" / "a_000003.pent").exists():
        assert process.poll() is None
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert said == "interrupted\n"
    run = pentimento.Run(tmp_path / "run")
    assert run.report["verdict"] == "stopped"
    frames = len(run)
    assert 3 < frames < 3000
    tables = run.scene.tables
    tables["scene"]["frames"] = frames + 1
    again = pentimento.Scene(tables).run(tmp_path / "run", threads=1, resume=True)
    assert again.report["verdict"] == "finished" and len(again) == frames + 2


def test_a_program_that_is_not_there_is_said_to_be_missing(monkeypatch, tmp_path):
    monkeypatch.setenv("PENTIMENTO_BIN", str(tmp_path))
    monkeypatch.setenv("PATH", "")
    with pytest.raises(pentimento.ProgramError, match="pent-mesh is neither in .* PENTIMENTO_BIN"):
        _programs.find("pent-mesh")


def test_progress_is_shown_where_tqdm_is(simulation, monkeypatch, capsys):
    pytest.importorskip("tqdm")
    simulation.step(3, progress=True)
    assert "3/3" in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)  # as if it were not installed
    assert simulation.step(3, progress=True).step == 6
    assert capsys.readouterr().err == ""
