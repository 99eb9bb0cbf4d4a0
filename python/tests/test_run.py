"""Run folders."""

import json
import pathlib
import shutil

import numpy as np
import pytest
from conftest import ROOT, two_boxes

from pentimento import Error, Frame, Run, Scene


@pytest.fixture(scope="module")
def run(tmp_path_factory, tesseract):
    return two_boxes(tesseract).run(tmp_path_factory.mktemp("runs") / "run")


def test_a_run_has_what_the_folder_has(run):
    assert run.bodies == ("high", "low")
    assert run.frames == tuple(range(7)) and len(run) == 7
    assert run.report["verdict"] == "finished"
    assert run.report == json.loads((run.path / "report.json").read_text())
    frame = run.frame(3, "low")
    assert (frame.number, frame.step) == (3, 6)
    assert frame.time == pytest.approx(0.1)
    assert run.frame(-1).number == 6
    np.testing.assert_array_equal(run.times(), [run.frame(n).time for n in run.frames])
    stacked = run.array("velocities", "low")
    assert stacked.shape == (7, 16, 4)
    np.testing.assert_array_equal(stacked[3], frame.velocities)
    assert [f.number for f in run.iterate()] == list(run.frames)


def test_reading_all_frames_does_not_list_the_folder_for_each(run, monkeypatch):
    listings = []
    glob = pathlib.Path.glob
    monkeypatch.setattr(
        pathlib.Path, "glob", lambda path, pattern: listings.append(pattern) or glob(path, pattern)
    )
    for read in (run.times, run.array, lambda: list(run.iterate()), lambda: run.frame(-1)):
        listings.clear()
        read()
        assert len(listings) <= 1


def test_reading_all_bodies_does_not_look_for_all_of_them_for_each(run, monkeypatch):
    questions = []
    exists = pathlib.Path.exists
    monkeypatch.setattr(
        pathlib.Path, "exists", lambda path: questions.append(path.name) or exists(path)
    )
    fresh = Run(run.path)
    for _ in range(3):
        for name in fresh.bodies:
            for number in range(7):
                fresh.frame(number, name)
    files = [name for name in questions if name.endswith(".pent")]
    assert len(files) == 3 * 2 * 7 + 2 * 7  # its own for each, and those of all once


def test_a_frame_that_goes_is_missed(run, tmp_path):
    shrinking = Run(shutil.copytree(run.path, tmp_path / "run"))
    assert shrinking.frame(6, "high").number == 6
    (shrinking.path / "frames" / "high_000006.pent").unlink()
    with pytest.raises(IndexError, match="has no frame 6; there are 0 to 5"):
        shrinking.frame(6, "high")


def test_a_frame_is_there_when_every_body_has_it(run, tmp_path):
    growing = Run(shutil.copytree(run.path, tmp_path / "run"))
    (growing.path / "frames" / "high_000006.pent").unlink()
    with pytest.raises(IndexError, match="has no frame 6; there are 0 to 5"):
        growing.frame(6, "low")
    assert growing.frame(-1, "low").number == 5


def test_frames_are_what_the_numpy_reader_reads(run, tmp_path):
    code = (ROOT / "docs" / "read_pent.py").read_text()
    names: dict = {"__name__": "reader"}
    exec(compile(code, "read_pent.py", "exec"), names)
    _, arrays = names["read_pent"](run.path / "frames" / "low_000004.pent")
    frame = run.frame(4, "low")
    for axis, name in enumerate("xyzw"):
        np.testing.assert_array_equal(frame.positions[:, axis], arrays["vertex"][name])
        np.testing.assert_array_equal(frame.velocities[:, axis], arrays["vertex"]["v" + name])


def test_a_slice_of_a_frame_is_that_of_its_vertices(run):
    own = run.slice(5, "low", offset=0.5)
    same = run.mesh("low").slice(offset=0.5, points=run.frame(5, "low").positions)
    assert own.volume > 0.5
    np.testing.assert_array_equal(own.points, same.points)


def test_further_quantities_have_their_names(tmp_path, tesseract):
    tables = two_boxes(tesseract).tables
    for body in tables["body"]:
        body["mesh"] = tesseract
    tables["output"] = {**tables.get("output", {}), "vertex": ["reaction", "energy_density"]}
    frame = Scene(tables).run(tmp_path / "run").frame(-1, "low")
    assert frame.fields["reaction"].shape == (16, 4)
    assert frame.fields["energy_density"].shape == (16,)


def test_what_is_not_there_is_said(run, tmp_path):
    with pytest.raises(Error, match="expected the folder of a run"):
        Run(tmp_path)
    with pytest.raises(IndexError, match="has no frame 99; there are 0 to 6"):
        run.frame(99)
    with pytest.raises(IndexError, match="has no frame -8"):
        run.frame(-8)
    with pytest.raises(TypeError, match="frame: found 1.5"):
        run.frame(1.5)
    with pytest.raises(Error, match='no body is called "x"; there are high, low'):
        run.frame(0, "x")
    with pytest.raises(IndexError, match="body: found 2; expected 0 to 1"):
        run.frame(0, 2)
    with pytest.raises(Error, match="frame 0: has no speed; there are positions, velocities"):
        run.array("speed")
    with pytest.raises(Error, match="no/such"):
        Frame.read("/no/such/frame.pent")


def test_frames_of_another_mesh_are_refused(run, tmp_path):
    shutil.copytree(run.path, tmp_path / "run")
    changed = Run(tmp_path / "run")
    changed.mesh("low").write(tmp_path / "run" / "meshes" / "low.pent", ascii=True)
    with pytest.raises(Error, match="of another mesh"):
        Run(tmp_path / "run").frame(1, "low")


def test_a_run_shows_itself(run):
    page = run._repr_html_()
    assert "finished" in page and "0 to 6" in page and "data:image/png;base64," in page
    assert run._repr_png_()[:4] == b"\x89PNG"
    assert "high, low" in repr(run)
