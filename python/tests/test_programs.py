"""The programs: every option is a keyword, and errors are exceptions with their line."""

import inspect
import multiprocessing
import pathlib
import re
import subprocess

import numpy as np
import pytest
from conftest import box, two_boxes

import pentimento
from pentimento import Error, Image, Mesh, ProgramError, _programs, _toml, make_mesh, render


def options_of(program: str) -> set[str]:
    path = _programs.find(program)
    text = subprocess.run([path, "--help"], capture_output=True, text=True).stdout
    found = set(re.findall(r"^ +(?:-\w,)?--([a-z][a-z-]*)", text, re.M))
    return {name.replace("-", "_") for name in found} - {"help", "version", "quiet", "json"}


def keywords_of(function) -> set[str]:
    return set(inspect.signature(function).parameters)


@pytest.mark.parametrize(
    ("program", "functions", "without"),
    [
        # What it prints is in Mesh.report; slabs are several meshes.
        ("pent-mesh", [make_mesh], {"quality", "slabs"}),
        ("pent-render", [render, pentimento.movie], set()),
        # Its files are read; the boundary of a mesh is Mesh.boundary().
        ("pent-slice", [pentimento.slice], {"format", "boundary", "output"}),
        # Methods of Study are the parts of a study.
        (
            "pent-study",
            [pentimento.study, pentimento.Study.prepare],
            {"output", "prepare", "list_runs", "run", "collect"},
        ),
        ("pent-convert", [pentimento.convert], set()),
        ("pent-sim", [pentimento.Scene.run], {"explain", "schema", "output"}),
    ],
)
def test_every_option_is_a_keyword(program, functions, without):
    try:
        options = options_of(program)
    except ProgramError:
        pytest.skip(f"{program} was not built")
    keywords = set().union(*map(keywords_of, functions))
    common = {"threads"} if program == "pent-convert" else set()  # has nothing to share out
    assert options - without - common <= keywords


def test_a_body_of_arrays_is_the_body_of_the_file(tmp_path):
    # The surface of a cube as a solid's, and its tetrahedra.
    cube = Mesh(*box(3))
    surface = cube.slice()
    extruded = make_mesh((surface.points, surface.triangles), thickness=1.0, layers=1)
    assert extruded.hypervolume == pytest.approx(1, abs=1e-12)
    stacked = make_mesh((cube.points, cube.cells), thickness=2.0, one_sided=True, layers=2)
    assert stacked.hypervolume == pytest.approx(2, abs=1e-12)
    assert stacked.layers is not None and set(stacked.layers) == {0, 1, 2}
    assert stacked.report["program"] == "pent-mesh"
    with pytest.raises(ValueError, match="cells: found 5 corners; expected 3 or 4"):
        make_mesh((cube.points, np.zeros((1, 5), int)))
    with pytest.raises(TypeError, match="input: expected a path"):
        make_mesh(3)


def test_a_program_that_refuses_raises_its_line(tmp_path):
    with pytest.raises(ProgramError, match="^nothing.obj: ") as caught:
        make_mesh("nothing.obj")
    assert caught.value.program == "pent-mesh" and caught.value.exit_code == 1
    with pytest.raises(ProgramError, match="--layers"):
        make_mesh(ball=1, layers=-1)
    with pytest.raises(ProgramError, match="unknown option --layer; did you mean --layers"):
        make_mesh(ball=1, layer=1)
    with pytest.raises(TypeError, match="quality: is no keyword of make_mesh"):
        make_mesh(ball=1, quality=True)
    with pytest.raises(TypeError, match="layers: found object"):
        make_mesh(ball=1, layers=object())
    (tmp_path / "-x.obj").write_text("")
    with pytest.raises(ProgramError, match="x.obj"):  # a name, not an option
        make_mesh("-x.obj")


def test_what_a_program_refuses_in_a_worker_is_raised_by_the_pool():
    with multiprocessing.get_context("fork").Pool(1) as pool:
        refused = pool.map_async(make_mesh, ["nothing.obj"])
        with pytest.raises(ProgramError, match="^nothing.obj: ") as caught:
            refused.get(timeout=60)
    assert caught.value.program == "pent-mesh" and caught.value.exit_code == 1


def test_a_picture_is_an_array_and_a_file(tesseract, tmp_path):
    image = render(tesseract, size=(120, 80), w=0.5)
    assert image.array.shape == (80, 120, 3) and repr(image) == "<pentimento.Image: 120 x 80>"
    assert image._repr_png_()[:8] == b"\x89PNG\r\n\x1a\n"
    assert np.asarray(image).std() > 1  # something is to be seen
    image.save(tmp_path / "a.png")
    assert Image((tmp_path / "a.png").read_bytes()).png == image.png


def test_pixels_are_those_of_ffmpeg(tesseract, tmp_path):
    image = render(tesseract, size=(121, 77))
    image.save(tmp_path / "a.png")
    words = ["-loglevel", "error", "-i", tmp_path / "a.png", "-f", "rawvideo", "-pix_fmt", "rgb24"]
    raw = subprocess.run(["ffmpeg", *words, "-"], capture_output=True, check=True).stdout
    np.testing.assert_array_equal(image.array, np.frombuffer(raw, np.uint8).reshape(77, 121, 3))


def test_what_is_no_picture_is_refused():
    for data in (b"", b"abc", b"\x89PNG\r\n\x1a\n" + b"\0" * 40):
        with pytest.raises(Error, match="no PNG file"):
            Image(data).array


def test_slices_of_the_program_are_those_of_the_library(tesseract):
    (made,) = pentimento.slice(tesseract, w=0.25, color="w")
    own = tesseract.slice(offset=0.25)
    assert (made.body, made.frame, made.index) == ("mesh", 0, 0)
    assert made.surface.volume == pytest.approx(own.volume, abs=1e-12)
    assert len(made.surface.points) == len(own.points)
    assert {"red", "green", "blue"} <= set(made.surface.attributes)
    # A turn within the picture changes no volume.
    (one,) = pentimento.slice(tesseract, w=0.4, rotate="xw:30")
    (both,) = pentimento.slice(tesseract, w=0.4, rotate=["xw:30", "yz:20"])
    assert both.surface.volume == pytest.approx(one.surface.volume, abs=1e-12)
    assert not np.allclose(both.surface.points, one.surface.points)
    (same,) = pentimento.slice(tesseract, w=0.4, rotate={"xw": 30, "yz": np.float64(20)})
    np.testing.assert_array_equal(same.surface.points, both.surface.points)


def test_slices_of_a_run_have_body_frame_and_number(tesseract, tmp_path):
    run = two_boxes(tesseract).run(tmp_path / "run")
    made = pentimento.slice(run, frames="2:4:2", w=[0.25, 0.5], obstacles=True)
    found = {(one.body, one.frame, one.index) for one in made}
    bodies = {(b, f, i) for b in ("low", "high") for f in (2, 4) for i in (0, 1)}
    assert bodies <= found and any(body.startswith("obstacle") for body, _, _ in found - bodies)
    for frames in ([2, 4], range(2, 5, 2), np.array([2, 4]), ["2", 4]):
        listed = pentimento.slice(run, frames=frames, w=[0.25, 0.5], obstacles=True)
        assert {(one.body, one.frame, one.index) for one in listed} == found
    movie = pentimento.movie(run, tmp_path / "movie.mp4", size=(64, 48), fps=10)
    assert movie.stat().st_size > 0
    with pytest.raises(TypeError, match="colour: is no keyword of movie"):
        pentimento.movie(run, tmp_path / "movie.mp4", colour="speed")
    with pytest.raises(ProgramError, match="nothing called .taste. to color by"):
        render(run, color="taste")
    with pytest.raises(TypeError, match="expected a Mesh, a Run or a path"):
        render(3)


def test_slices_have_the_names_of_their_bodies_whatever_these_are(tesseract, tmp_path):
    names = ["a", "a_s01", "a_outline", "a_000002"]
    scene = pentimento.SceneBuilder(frames=1)
    for name in names:
        scene.body(name, tesseract)
    run = scene.build().run(tmp_path / "run")
    for count in (1, 2):
        made = pentimento.slice(run, w=[0.25, 0.5][:count], project="orthographic", color="w")
        bodies = {(b, f, i) for b in names for f in (0, 1) for i in range(count)}
        outlines = {(f"{b}.outline", f, 0) for b in names for f in (0, 1)}
        assert {(one.body, one.frame, one.index) for one in made} == bodies | outlines
        assert len(made) == len(bodies | outlines)
        for one in made:
            if "." not in one.body:
                assert one.surface.attributes["w"] == pytest.approx(0.25 * (one.index + 1))


@pytest.mark.parametrize("name", ["ü, b", 'say "c"', "two\nlines", "a&b"])
def test_a_mesh_of_any_name_is_sliced(tesseract, tmp_path, name):
    tesseract.write(tmp_path / f"{name}.pent")
    (made,) = pentimento.slice(tmp_path / f"{name}.pent", w=0.25)
    assert made.body == name and made.surface.volume == pytest.approx(1, abs=1e-12)


def test_a_movie_is_where_it_is_said_to_be_without_ffmpeg_too(tesseract, tmp_path, monkeypatch):
    monkeypatch.setenv("PENTIMENTO_BIN", str(pathlib.Path(_programs.find("pent-render")).parent))
    monkeypatch.setenv("PATH", "/nonexistent")
    look = {"sweep": True, "w": [0.25, 0.5], "size": (64, 48)}
    made = pentimento.movie(tesseract, tmp_path / "a.mp4", **look)
    assert len(list(made.glob("*.png"))) == 2 and not (tmp_path / "a.mp4").exists()


def test_a_size_is_any_two_numbers(tesseract):
    for size in ((64, 48), [64, 48], np.array([64, 48])):
        assert np.asarray(render(tesseract, size=size)).shape == (48, 64, 3), size


def test_a_mesh_shows_itself(tesseract):
    page = tesseract._repr_html_()
    assert "pentachora</th><td>24" in page and "data:image/png;base64," in page
    assert tesseract._repr_png_()[:4] == b"\x89PNG"
    assert "4D, 16 vertices, 24 pentachora" in repr(tesseract)
    flat = Mesh(*box(2))
    assert flat._repr_png_() is None and "triangles" in flat._repr_html_()


def test_bodies_go_to_other_programs_and_come_back(tesseract, tmp_path):
    report = pentimento.convert(tesseract, tmp_path / "a.4off")
    assert report["vertices"] == 16
    pentimento.convert(tmp_path / "a.4off", tmp_path / "a.pent")
    assert Mesh.read(tmp_path / "a.pent").hypervolume == pytest.approx(1, abs=1e-12)
    with pytest.raises(ProgramError, match="a.xyz"):
        pentimento.convert(tesseract, tmp_path / "a.xyz")


def test_any_value_of_a_scene_is_varied(tmp_path, tesseract):
    scene = two_boxes(tesseract).tables
    for body in scene["body"]:
        body["mesh"] = "a.pent"
    tesseract.write(tmp_path / "a.pent")
    (tmp_path / "s.toml").write_text(_toml.dumps(scene))
    try:
        _programs.find("pent-study")
    except ProgramError:
        pytest.skip("pent-study was not built")

    def plan(name, vary):
        pentimento.Study.prepare(tmp_path / "s.toml", tmp_path / name, vary)
        return (tmp_path / name / "plan.json").read_bytes()

    varied = {
        "contact.self": [True, False],
        "scene.gravity": [(0, -9.5, 0, 0), np.array([0.0, 0.0, 0.0, -1.0])],
        "body.place.rotate": [[], [{"plane": "xw", "degrees": 5}]],
        "body.material.young": 2e4,
        "dt": np.array([1 / 30, 1 / 60]),
    }
    words = {
        "contact.self": "true,false",
        "scene.gravity": "[0, -9.5, 0, 0],[0.0, 0.0, 0.0, -1.0]",
        "body.place.rotate": '[],[{ plane = "xw", degrees = 5 }]',
        "body.material.young": "20000.0",
        "dt": f"{1 / 30!r},{1 / 60!r}",
    }
    assert plan("varied", varied) == plan("words", words)
    with pytest.raises(TypeError, match="dt: found NoneType; expected a number"):
        plan("none", {"dt": [None]})


def test_a_frontier_shows_itself(tmp_path, tesseract):
    tesseract.write(tmp_path / "a.pent")
    (tmp_path / "s.toml").write_text(
        '[scene]\nframes = 4\ngravity = [0, -9, 0, 0]\n[[body]]\nname = "a"\nmesh = "a.pent"\n'
        '[[constraint]]\nbody = "a"\n'
        "select = { box = { low = [-1, 0.9, -1, -1], high = [2, 2, 2, 2] } }\n"
    )
    try:
        _programs.find("pent-study")
    except ProgramError:
        pytest.skip("pent-study was not built")
    vary = {"dt": ["1/30", "1/60"]}
    found = pentimento.study(tmp_path / "s.toml", tmp_path / "study", vary, repeat=1)
    assert len(found.results) == 2 and 1 <= len(found.frontier) <= 2
    assert found._repr_png_()[:4] == b"\x89PNG" and "<li>" in found._repr_html_()
    with pytest.raises(Error, match="expected the folder of a finished study"):
        pentimento.Frontier(tmp_path)
    # The same in parts, in another order.
    vary = {"dt": "1/30,1/60"}  # as pent-study has it
    parts = pentimento.Study.prepare(tmp_path / "s.toml", tmp_path / "parts", vary, repeat=1)
    assert [unit.number for unit in parts.units] == [1, 2, 3, 4, 5]
    assert parts.units[3] == pentimento.Unit(4, "combination", "runs/dt-1_30", False)
    with pytest.raises(ProgramError, match="not been run to their end: 1-5"):
        parts.collect()
    with pytest.raises(ProgramError, match="units 1 to 5"):
        parts.run(6)
    for unit in reversed(parts.units):
        assert parts.run(unit.number) == "finished"
    assert repr(pentimento.Study(tmp_path / "parts")).endswith("5 of 5 units>")
    collected = parts.collect(error=50)
    assert [result["errors"] for result in collected.results] == [
        result["errors"] for result in found.results
    ]
    with pytest.raises(ProgramError, match="no study has been prepared"):
        pentimento.Study(tmp_path)
