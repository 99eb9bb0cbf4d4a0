"""Scenes say what is wrong in the words of pent-sim."""

import math
import pathlib
import shlex
import subprocess
import tomllib

import numpy as np
import pytest
from conftest import two_boxes

from pentimento import Error, Mesh, ProgramError, Scene, SceneBuilder, _programs, _toml

BODY = '[[body]]\nname = "a"\nmesh = "a.pent"\n'


def line_of_pent_sim(path: pathlib.Path) -> str:
    words = [_programs.find("pent-sim"), path, "-o", path.parent / "run"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 1
    return done.stderr.splitlines()[-1].removeprefix("pent-sim: ")


@pytest.mark.parametrize(
    "text",
    [
        "[scene]\ngravitty = 3\n" + BODY,
        "[scene\n" + BODY,
        "[scene]\ngravity = [1, 2]\n" + BODY,
        "[scene]\nframes_per_second = -1\n" + BODY,
        BODY + BODY,
        BODY + 'material = { model = "wood" }\n',
        BODY + '[[constraint]]\nbody = "b"\nselect = "everything"\n',
        "",
    ],
)
def test_a_scene_that_is_wrong_gets_the_line_of_pent_sim(tmp_path, tesseract, text):
    path = tmp_path / "scene.toml"
    path.write_text(text)
    tesseract.write(tmp_path / "a.pent")
    with pytest.raises(Error) as caught:
        Scene.read(path).simulate()
    assert str(caught.value) == line_of_pent_sim(path)


@pytest.mark.parametrize(
    "text",
    [
        BODY,  # the mesh is not there
        BODY.replace("a.pent", "scene.toml"),
    ],
)
def test_a_mesh_that_is_wrong_gets_the_line_of_pent_sim(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(text)
    with pytest.raises(Error) as caught:
        Scene.read(path).simulate()
    assert str(caught.value) in line_of_pent_sim(path)


def test_what_selects_nothing_gets_the_line_of_pent_sim(tmp_path, tesseract):
    path = tmp_path / "scene.toml"
    path.write_text(BODY + '[[constraint]]\nbody = "a"\nselect = { layers = { first = 7 } }\n')
    tesseract.write(tmp_path / "a.pent")
    with pytest.raises(Error) as caught:
        Scene.read(path).simulate()
    assert str(caught.value) == line_of_pent_sim(path)


def test_file_text_and_dict_are_one_scene(tmp_path, tesseract):
    text = "[scene]\ngravity = [0, -9.8, 0, 0]\n" + BODY + "[contact]\ndistance = 0.1\n"
    (tmp_path / "s.toml").write_text(text)
    tesseract.write(tmp_path / "a.pent")
    read = Scene.read(tmp_path / "s.toml")
    assert Scene.from_text(text, folder=tmp_path).text == read.text
    assert Scene(tomllib.loads(text), folder=tmp_path).text == read.text
    built = SceneBuilder(gravity=(0, -9.8, 0, 0)).body("a", "a.pent")
    built.contact(distance=np.float64(0.1))
    assert built.build(folder=tmp_path).text == read.text
    assert Scene(read.tables).text == read.text
    assert read.bodies == ("a",) and read.dimension == 4
    assert read.mesh("a").hypervolume == pytest.approx(1)
    with pytest.raises(Error, match='no body is called "b"; there are a'):
        read.mesh("b")


def test_every_key_of_a_block_is_a_keyword(tesseract):
    # All keys with their defaults, as of a scene that was checked; one of [contact] is `self`.
    scene = two_boxes(tesseract)
    full = scene.tables
    built = SceneBuilder(**full["scene"])
    for body in full["body"]:
        built.body(**{**body, "mesh": tesseract})
    built.contact(**full["contact"]).solver(**full["solver"])
    for obstacle in full["obstacle"]:
        built.obstacle(**obstacle)
    others = full.keys() - {"scene", "body", "contact", "solver", "obstacle"}
    for name in others:
        built.table(name, **full[name])
    assert built.build().tables == full


def test_a_run_of_a_scene_built_in_python_runs_again_by_itself(tmp_path, tesseract):
    run = two_boxes(tesseract).run(tmp_path / "one")
    again = run.scene.run(tmp_path / "two")
    np.testing.assert_array_equal(run.array(), again.array())
    np.testing.assert_array_equal(run.mesh("high").points, again.mesh("high").points)


def test_a_scene_from_another_folder_runs_as_pent_sim_runs_it(tmp_path, tesseract, monkeypatch):
    there = tmp_path / "scenes"
    there.mkdir()
    (tmp_path / "models").mkdir()
    (tmp_path / "models" / "my shape.obj").write_text("v 0 0 0\n")
    (there / "profile.txt").write_text("0 1\n1 1\n")
    tesseract.write(there / "a.pent")
    recipe = "'../models/my shape.obj' --profile=profile.txt --layers 2 none.txt"
    text = f"[scene]\nframes = 1\n{BODY}recipe = \"{recipe}\"\n"
    (there / "scene.toml").write_text(text)
    pent_sim = _programs.find("pent-sim")
    for at, name in ((tmp_path, "scenes/scene.toml"), (there, there / "scene.toml")):
        monkeypatch.chdir(at)
        scene = Scene.read(name)
        run = scene.run("by python", force=True)
        subprocess.run([pent_sim, name, "-o", "by pent-sim", "--quiet", "--force"], check=True)
        for file in ("scene.toml", "meshes/a.pent", "frames/a_000001.pent"):
            assert (run.path / file).read_bytes() == (at / "by pent-sim" / file).read_bytes()
        words = run.scene.tables["body"][0]["recipe"]
        assert words.endswith("--layers 2 none.txt")
        shape = shlex.split(words)[0]
        assert (run.path / shape).samefile(tmp_path / "models" / "my shape.obj")
    # What was read stays as it was written.
    assert scene.tables["body"][0]["recipe"] == recipe


def test_a_folder_that_is_taken_is_refused(tmp_path, tesseract):
    scene = two_boxes(tesseract)
    scene.run(tmp_path / "run")
    with pytest.raises(ProgramError, match="run") as caught:
        scene.run(tmp_path / "run")
    assert caught.value.program == "pent-sim" and caught.value.exit_code == 1
    scene.run(tmp_path / "run", force=True)


@pytest.mark.parametrize("words", [{}, {"resume": True}, {"force": True, "isa": "none"}])
def test_a_run_that_is_refused_leaves_the_meshes_of_the_one_there(tmp_path, tesseract, words):
    run = two_boxes(tesseract).run(tmp_path / "run")
    other = two_boxes(Mesh(tesseract.points * [2, 1, 1, 1], tesseract.cells))
    with pytest.raises(ProgramError):
        other.run(tmp_path / "run", **words)
    again = run.scene.run(tmp_path / "again")
    np.testing.assert_array_equal(run.array(), again.array())
    mine = tmp_path / "run.meshes" / "mine.pent"
    tesseract.write(mine)
    replaced = other.run(tmp_path / "run", force=True)
    files = {str(file) for file in (tmp_path / "run.meshes").iterdir()}
    assert files == {str(mine), *(body["mesh"] for body in replaced.scene.tables["body"])}


def test_any_value_goes_through_toml():
    tables = {
        "a": {"text": 'quote " \\ \n \x7f \x01 é', "yes": True, "n": -3, "x": 1e-300},
        "y": {"y": math.inf},
        "b": [{"list": [1.5, [2, 3]], "table": {"key with space": "z"}, "empty": []}, {}],
    }
    assert tomllib.loads(_toml.dumps(tables)) == tables
    for value in (None, object(), {3: 4}, 1j):
        with pytest.raises(TypeError, match=r"a\.x|the key 3"):
            _toml.dumps({"a": {"x": value}})
    with pytest.raises(TypeError, match="a: found int; expected a table"):
        _toml.dumps({"a": 3})


def test_meshes_that_fit_nothing_are_refused(tesseract, cube):
    text = '[[body]]\nname = "a"\nmesh = "given"\n'
    with pytest.raises(Error, match='the body "b"'):
        Scene.from_text(text, meshes={"b": tesseract})
    with pytest.raises(TypeError, match="the mesh of a: found int"):
        Scene.from_text(text, meshes={"a": 3})
    with pytest.raises(Error, match="a mesh of 3 dimensions was given; the scene has 4"):
        Scene.from_text(text, meshes={"a": cube}).simulate()
    with pytest.raises(TypeError, match="text: found int"):
        Scene.from_text(3)
    with pytest.raises(IndexError, match="threads: found 0; expected 1 to 1024"):
        Scene.from_text(text, meshes={"a": tesseract}).simulate(threads=0)
