"""What programs that show slices look at."""

import math
import shutil

import host_runs
import numpy as np
import pytest
from boxes import box

import pentimento
from pentimento import Error, Mesh, View


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("hosts")
    host_runs.make(folder)
    return folder


def program(data, body, frame, **look):
    made = pentimento.slice(data, frames=frame, **look)
    return next(one.surface for one in made if one.body == body)


@pytest.mark.parametrize(
    "rotate", [{}, {"xw": 30}, {"zw": 12.5, "yz": -30, "xw": 170}, {"zw": 90, "xy": 0.1}]
)
def test_slices_are_those_of_pent_slice_to_the_bit(data, rotate):
    view = View(data / "run")
    words = [f"{plane}:{angle}" for plane, angle in rotate.items()] or None
    offset = view.middle(rotate) + 0.03
    for body in view.bodies:
        made = program(data / "run", body, 5, w=offset, rotate=words)
        found = view.slice(body, 5, rotate, offset)
        np.testing.assert_array_equal(found.points, made.points)
        np.testing.assert_array_equal(found.triangles, made.triangles)
        assert len(found.triangles) > 0
        as_text = view.slice(body, 5, ",".join(words or []) or None, offset)
        np.testing.assert_array_equal(as_text.points, found.points)


@pytest.mark.parametrize("quantity", ["w", "speed", "strain", "force"])
def test_attributes_and_colors_are_those_of_pent_slice(data, quantity):
    view = View(data / "run")
    found = [view.slice(body, 4, None, 0.5) for body in view.bodies]
    ranges = [surface.color_range(quantity) for surface in found]
    for body, surface in zip(view.bodies, found):
        made = program(data / "run", body, 4, w=0.5, color=quantity).attributes
        np.testing.assert_allclose(surface.attributes[quantity], made[quantity], rtol=1e-13)
        assert surface.color_range(quantity)[1] <= max(high for _, high in ranges)
        linear = surface.colors(quantity, 0, 1)
        assert linear.shape == (len(surface.points), 3) and 0 <= linear.min() <= linear.max() <= 1


@pytest.mark.parametrize("quantity", ["heat", "flow", "phase"])
def test_quantities_of_meshes_are_seen_as_pent_slice_has_them(tmp_path, quantity):
    points, cells = box(4, 2)
    middles = points[cells].mean(axis=1)
    mesh = Mesh(
        points, cells, vertex_fields={"heat": points @ [1, -2, 3, -4], "flow": points - 0.5},
        cell_fields={"phase": middles @ [3, 1, -1, -2], "body": middles[:, 0] + 5},
    )  # fmt: skip
    mesh.write(tmp_path / "a.pent")
    found = View(tmp_path / "a.pent").slice("a", 0, {"xw": 20}, 0.2)
    made = pentimento.slice(tmp_path / "a.pent", w=0.2, rotate="xw:20", color=quantity)[0].surface
    values = found.attributes[quantity]
    np.testing.assert_array_equal(values, made.attributes[quantity])
    assert found.attributes["body"].max() == 0  # its number, whatever meshes have by that name
    low, high = found.color_range(quantity)
    assert values.min() <= low < high <= values.max()
    assert found.colors(quantity, low, high).shape == (len(found.points), 3)


def test_a_body_has_the_color_of_pent_slice(data):
    view = View(data / "run")
    for body in view.bodies:
        made = program(data / "run", body, 0, w=0.5).attributes
        linear = view.slice(body, 0, None, 0.5).colors("body", 0, 0)[0].astype(float)
        srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
        found = [round(255 * value) for value in srgb]
        assert found == [made[channel][0] for channel in ("red", "green", "blue")]


def test_a_tilted_tesseract_is_a_long_box(data):
    view = View(data / "tesseract.pent")
    assert (view.bodies, view.frames, view.dimension) == (("tesseract",), (0,), 4)
    assert view.frames_per_second == 0
    found = view.slice("tesseract", 0, **host_runs.TILTED, shading=True)
    assert found.volume == pytest.approx(host_runs.TILTED_VOLUME, abs=1e-12)
    assert found.area == pytest.approx(host_runs.TILTED_AREA, abs=1e-12)
    corners = found.points[found.triangles]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flat /= np.linalg.norm(flat, axis=1)[:, None]
    # Flat sides between sharp edges: the smooth normals are those of the triangles.
    smooth = np.broadcast_to(flat[:, None], (len(flat), 3, 3))
    np.testing.assert_allclose(found.normals, smooth, atol=1e-12)


@pytest.mark.parametrize("rotate", [None, {"xw": 30}, {"zw": 45, "xy": 20}])
def test_the_middle_is_where_pent_slice_slices_by_itself(data, rotate):
    view = View(data / "run")
    words = None if rotate is None else [f"{plane}:{angle}" for plane, angle in rotate.items()]
    made = program(data / "run", "low", 3, rotate=words)
    found = view.slice("low", 3, rotate, view.middle(rotate))
    np.testing.assert_allclose(found.points, made.points, atol=1e-12)


@pytest.mark.parametrize("side", [1, -1])
def test_a_middle_between_two_roundings_is_the_outer_one_as_of_pent_slice(tmp_path, side):
    points, cells = box(4)
    points = points * [1, 1, 1, 0.125] - [0, 0, 0, 0.125 if side < 0 else 0]
    Mesh(points, cells).write(tmp_path / "thin.pent")
    view = View(tmp_path / "thin.pent")
    assert view.middle() == pytest.approx(side * 0.063)  # of 0.0625
    made = program(tmp_path / "thin.pent", "thin", 0, color="w")
    assert made.attributes["w"] == pytest.approx(view.middle())


def test_time_and_frames_are_those_of_the_run(data):
    view = View(data / "run")
    assert view.frames == tuple(range(9))
    assert view.frames_per_second == pytest.approx(30)
    assert view.time(3) == pytest.approx(0.1)
    assert [view.frame_at(number) for number in (-5, 0, 2.9, 3, 99)] == [0, 0, 2, 3, 8]


def test_it_says_what_it_looks_at(data, tmp_path, tesseract):
    path = data / "run"
    assert repr(View(path)) == f"<pentimento.View: {path}, 4D, high, low, 9 frames>"
    mesh = tmp_path / "a.pent"
    tesseract.write(mesh)
    assert repr(View(mesh)) == f"<pentimento.View: {mesh}, 4D, a, 1 frame>"


def test_frames_that_come_are_seen_after_a_refresh(data, tmp_path):
    shutil.copytree(data / "run", tmp_path / "run")
    late = tmp_path / "run" / "frames" / "high_000004.pent"
    shutil.move(late, tmp_path)
    view = View(tmp_path / "run")
    assert view.frames == (0, 1, 2, 3, 5, 6, 7, 8) and view.frame_at(4) == 3
    shutil.move(tmp_path / late.name, late)
    view.refresh()
    assert view.frames == tuple(range(9))


def test_three_dimensional_bodies_are_seen_whole(data):
    view = View(data / "solid")
    assert (view.dimension, view.middle()) == (3, 0)
    made = program(data / "solid", "low", 3)
    for offset in (0, 99):
        found = view.slice("low", 3, {"xw": 30}, offset)
        np.testing.assert_array_equal(found.points, made.points)
        np.testing.assert_array_equal(found.triangles, made.triangles)


def test_what_is_nothing_to_see_is_refused(data, tmp_path):
    shutil.copytree(data / "run", tmp_path / "run")
    frame = tmp_path / "run" / "frames" / "low_000002.pent"
    frame.write_bytes(frame.read_bytes()[:-9])
    view = View(tmp_path / "run")
    with pytest.raises(Error, match="low_000002.pent: "):
        view.slice("low", 2)
    assert len(view.slice("low", 3, None, 0.5).triangles) > 0
    with pytest.raises(Error, match="2 dimensions"):
        View(data / "flat.pent")
    with pytest.raises(Error, match="expected the folder of a run"):
        View(tmp_path)
    with pytest.raises(Error, match="is a frame of the mesh"):
        View(data / "run" / "frames" / "low_000001.pent")
    with pytest.raises(Error, match='no body is called "lowest"; there are high, low'):
        view.slice("lowest", 3)
    for number in (-1, 9):
        with pytest.raises(Error, match=f"has no frame {number}; there are 0 to 8"):
            view.slice("low", number)
    with pytest.raises(Error, match="no attribute reaction; there are body, w, speed"):
        view.slice("low", 3).colors("reaction", 0, 1)


@pytest.mark.parametrize(
    "rotate, error",
    [("xx:3", ValueError), ("xv:3", ValueError), ("x", ValueError), (["xw"], ValueError),
     ({"xw": "3"}, TypeError), ({"wxy": 3}, ValueError), ([3], ValueError), ("xw:nan", Error)],
)  # fmt: skip
def test_rotations_that_are_none_are_refused(tesseract, rotate, error):
    with pytest.raises(error):
        tesseract.slice(rotate=rotate)


def test_a_slice_has_a_normal_or_rotations(tesseract):
    with pytest.raises(ValueError, match="normal: not together"):
        tesseract.slice((0, 0, 0, 1), rotate="xw:3")
    turned = tesseract.slice(rotate="xw:90", offset=0.25)
    across = tesseract.slice((1, 0, 0, 0), 0.25)
    assert turned.volume == pytest.approx(across.volume, abs=1e-12)


def test_a_stretch_has_its_strain():
    mesh = Mesh(*box(4))
    np.testing.assert_array_equal(mesh.strain(mesh.points), 0)
    np.testing.assert_allclose(mesh.strain(mesh.points * [1.5, 1, 1, 1]), 0.625, rtol=1e-14)
    turn = math.radians(30)
    rotation = np.eye(4)
    rotation[0, 0] = rotation[3, 3] = math.cos(turn)
    rotation[3, 0] = math.sin(turn)
    rotation[0, 3] = -math.sin(turn)
    np.testing.assert_array_equal(mesh.strain(mesh.points @ rotation.T), 0)
    with pytest.raises(Error, match="2 dimensions"):
        Mesh(*box(2)).strain(Mesh(*box(2)).points)
