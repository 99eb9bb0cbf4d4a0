"""Meshes, by arrays and by files."""

import json
import pickle
import subprocess

import numpy as np
import pytest
from conftest import box

import pentimento
from pentimento import Error, Mesh, _programs


def full(dimension: int) -> Mesh:
    """A mesh with everything that meshes may have, but parents."""
    points, cells = box(dimension, 2)
    random = np.random.default_rng(3)
    count = len(points)
    return Mesh(
        points,
        cells,
        regions=random.integers(0, 2**16, len(cells)),
        columns=np.arange(count) // 2,
        layers=np.arange(count) % 2,
        fibers=random.normal(size=(len(cells), dimension)),
        vertex_fields={"heat": random.normal(size=count), "flow": random.normal(size=points.shape)},
        cell_fields={"phase": random.normal(size=len(cells)), "heat": np.zeros(len(cells))},
        facets=cells[1:, 1:],
        labels=np.arange(len(cells) - 1),
        base_labels=np.arange(len(cells) - 1) + 7,
        bisection_tags=np.arange(len(cells)) % dimension,
    )


EVERYTHING = (
    "points", "cells", "regions", "columns", "layers", "fibers", "facets", "labels", "base_labels",
    "bisection_tags",
)  # fmt: skip


def assert_same(found: Mesh, expected: Mesh) -> None:
    for name in EVERYTHING:
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))
    for name in ("vertex_fields", "cell_fields"):
        fields = getattr(found, name)
        assert list(fields) == list(getattr(expected, name)) and len(fields) == 2
        for key, values in fields.items():
            np.testing.assert_array_equal(values, getattr(expected, name)[key])


@pytest.mark.parametrize("ascii", [False, True])
@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_a_mesh_goes_through_a_file_to_the_byte(tmp_path, dimension, ascii):
    made = full(dimension)
    made.write(tmp_path / "a.pent", ascii=ascii, created_by="me 1.0")
    read = Mesh.read(tmp_path / "a.pent")
    read.write(tmp_path / "b.pent", ascii=ascii)
    assert (tmp_path / "a.pent").read_bytes() == (tmp_path / "b.pent").read_bytes()
    assert read.created_by == "me 1.0"
    assert_same(read, made)
    assert read.parents is None


def test_what_is_beside_a_mesh_is_what_was_given(tesseract):
    points, cells = box(4, 2)
    mesh = full(4)
    random = np.random.default_rng(3)
    random.integers(0, 2**16, len(cells))
    random.normal(size=(len(cells), 4))
    np.testing.assert_array_equal(mesh.vertex_fields["heat"], random.normal(size=len(points)))
    assert mesh.vertex_fields["flow"].shape == points.shape
    np.testing.assert_array_equal(mesh.facets, cells[1:, 1:])
    np.testing.assert_array_equal(mesh.labels, np.arange(len(cells) - 1))
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertex_fields["heat"][0] = 1
    assert tesseract.vertex_fields == tesseract.cell_fields == {}
    assert tesseract.facets is tesseract.labels is tesseract.bisection_tags is None


@pytest.mark.parametrize("dimension", [3, 4])
def test_quantities_of_cells_have_means_by_volume_at_vertices(dimension):
    points, cells = box(dimension, 2)
    points[len(points) // 2] += 0.1  # the middle, so that volumes differ
    centers = points[cells].mean(axis=1)
    mesh = Mesh(
        points, cells, vertex_fields={"a": points[:, 0]},
        cell_fields={"a": np.zeros(len(cells)), "b": np.full(len(cells), 3), "c": centers},
    )  # fmt: skip
    found = mesh.quantities()
    np.testing.assert_array_equal(found["a"], points[:, 0])
    np.testing.assert_allclose(found["b"], 3, rtol=1e-14)
    volumes = mesh.cell_hypervolumes()
    for vertex in range(len(points)):
        around = (cells == vertex).any(axis=1)
        mean = (volumes[around, np.newaxis] * centers[around]).sum(axis=0) / volumes[around].sum()
        np.testing.assert_allclose(found["c"][vertex], mean, rtol=1e-14)


def test_parents_stay(tmp_path):
    made = pentimento.make_mesh(box=(1, 1, 1, 1), quadratic=True, output=tmp_path / "a.pent")
    assert made.parents is not None and len(made.parents) == made.cell_count
    made.write(tmp_path / "b.pent")
    assert (tmp_path / "a.pent").read_bytes() == (tmp_path / "b.pent").read_bytes()


@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_a_box_has_the_measures_of_a_box(dimension):
    mesh = full(dimension)
    assert mesh.hypervolume == pytest.approx(1, abs=1e-13)  # a few hundred roundings
    assert mesh.cell_hypervolumes().sum() == pytest.approx(1, abs=1e-13)
    np.testing.assert_array_equal(mesh.box, [[0] * dimension, [1] * dimension])
    # All faces of the box, 2^(d-1) squares each, cut into (d-1)! simplices.
    sides = {2: 1, 3: 2, 4: 6}[dimension]
    assert len(mesh.boundary()) == 2 * dimension * 2 ** (dimension - 1) * sides


@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_every_facet_of_the_boundary_looks_outward(dimension):
    mesh = full(dimension)
    facets = mesh.points[mesh.boundary()]
    outward = facets.mean(axis=1) - 0.5
    sides = facets[:, 1:] - facets[:, :1]
    assert (np.linalg.det(np.concatenate([outward[:, None], sides], axis=1)) > 0).all()


def test_quality_is_what_pent_check_says(tmp_path):
    mesh = pentimento.make_mesh(ball=2, thickness=0.5, output=tmp_path / "a.pent")
    words = [tmp_path / "a.pent", "--quiet", "--json", tmp_path / "a.json"]
    subprocess.run([_programs.find("pent-check"), *words], check=True)
    said = json.loads((tmp_path / "a.json").read_text())["quality"]["mean_ratio"]
    quality = mesh.quality()
    assert quality.min() == pytest.approx(said["min"], rel=1e-9)
    assert quality.max() == pytest.approx(said["max"], rel=1e-9)
    assert quality.mean() == pytest.approx(said["mean"], rel=1e-9)


@pytest.mark.parametrize("dimension", [2, 3, 4])
def test_a_regular_simplex_has_quality_one(dimension):
    # Unit vectors and one point that is as far from each: edges of the length sqrt(2).
    last = np.full(dimension, (1 - np.sqrt(dimension + 1)) / dimension)
    points = np.vstack([np.eye(dimension), last])
    order = list(range(dimension + 1))
    if np.linalg.det(points[1:] - points[0]) < 0:
        order[0], order[1] = order[1], order[0]
    assert Mesh(points, [order]).quality()[0] == pytest.approx(1, abs=1e-14)


def test_a_slice_of_a_tesseract_is_a_cube(tesseract):
    surface = tesseract.slice((0, 0, 0, 2), 0.5)  # w = 0.25
    assert surface.volume == pytest.approx(1, abs=1e-12)
    assert surface.area == pytest.approx(6, abs=1e-12)
    w = surface.interpolate(tesseract.points)[:, 3]
    np.testing.assert_allclose(w, 0.25, atol=1e-15)
    np.testing.assert_array_equal(surface.frame, np.eye(4))
    places = surface.interpolate(tesseract.points)[:, :3]
    np.testing.assert_allclose(surface.points, places, atol=1e-15)


def test_a_slice_is_where_the_vertices_are(tesseract):
    moved = tesseract.points * 2 + [0, 0, 0, 0.1]
    assert tesseract.slice(offset=0.3, points=moved).volume == pytest.approx(8, abs=1e-11)
    assert len(tesseract.slice(offset=9).triangles) == 0


def test_a_solid_is_its_own_slice(cube):
    assert cube.slice().volume == pytest.approx(1, abs=1e-14)


def test_a_mesh_survives_pickling():
    mesh = full(4)
    assert_same(pickle.loads(pickle.dumps(mesh)), mesh)


def test_any_order_of_memory_and_any_type_of_numbers_is_taken():
    points, cells = box(4)
    made = [
        Mesh(points, cells),
        Mesh(np.asfortranarray(points), cells.tolist()),
        Mesh(np.repeat(points, 2, axis=0)[::2].astype(np.float32), cells.astype(np.int8)),
        Mesh(points.astype(int), cells.astype(np.uint64)),
    ]
    for mesh in made:
        np.testing.assert_array_equal(mesh.points, points)
        np.testing.assert_array_equal(mesh.cells, cells)


def test_what_is_masked_is_not_taken_for_numbers():
    points, cells = box(4)
    whole = Mesh(np.ma.array(points), np.ma.array(cells))  # nothing of these is masked
    np.testing.assert_array_equal(whole.points, points)
    with pytest.raises(ValueError, match="points: found masked values; expected real numbers"):
        Mesh(np.ma.masked_greater(points, 0.5), cells)
    with pytest.raises(ValueError, match="cells: found masked values; expected whole numbers"):
        Mesh(points, np.ma.masked_equal(cells, 3))


@pytest.mark.parametrize(
    ("change", "kind", "words"),
    [
        ({"points": np.zeros((5, 7))}, ValueError, "points: found 7 columns; expected 2, 3 or 4"),
        ({"points": np.zeros(5)}, ValueError, "points: found the shape"),
        ({"points": "abc"}, TypeError, "points: found <U3; expected real numbers"),
        ({"points": np.zeros((16, 4), complex)}, TypeError, "points: found complex128"),
        ({"points": [[1, 2], [3]]}, (ValueError, TypeError), "points"),
        ({"cells": np.zeros((3, 4), int)}, ValueError, r"cells: found the shape \(3, 4\)"),
        ({"cells": [[0.0, 1, 2, 3, 4]]}, TypeError, "cells: found float64"),
        ({"cells": [[0, 1, 2, 3, -1]]}, IndexError, "cells: found -1; expected 0 to 15"),
        ({"cells": [[0, 1, 2, 3, 16]]}, IndexError, "cells: found 16; expected 0 to 15"),
        ({"cells": np.zeros((0, 5), int)}, Error, "16 vertices and 0 cells"),
        ({"cells": [[1, 1, 2, 3, 4]]}, Error, "mesh: pentachoron 0"),
        ({"regions": [1, 2]}, ValueError, "regions"),
        ({"regions": np.full(24, 2**16)}, IndexError, "regions: found 65536; expected 0 to 65535"),
        ({"layers": np.full(16, 2**32)}, IndexError, "layers"),
        ({"fibers": np.zeros((24, 3))}, ValueError, "fibers"),
        ({"fibers": np.full((24, 4), np.nan)}, Error, "fiber"),
        ({"points": np.full((16, 4), np.inf)}, Error, "mesh: "),
        ({"vertex_fields": {"a": np.zeros(15)}}, ValueError, r"vertex_fields\['a'\]: found"),
        ({"vertex_fields": {"a": np.zeros((16, 3))}}, ValueError, r"expected \(16, 4\)"),
        ({"vertex_fields": {3: np.zeros(16)}}, TypeError, "a name of vertex_fields: found int"),
        ({"vertex_fields": {"x": np.zeros(16)}}, Error, "'x': the property x has a meaning"),
        ({"vertex_fields": {"a b": np.zeros(16)}}, Error, "expected a name of letters"),
        ({"cell_fields": {"a": np.full(24, np.nan)}}, Error, "pentachoron 0: a is not finite"),
        ({"cell_fields": {"a": ["hot"] * 24}}, TypeError, r"cell_fields\['a'\]: found <U3"),
        ({"labels": [1]}, ValueError, "labels: expected facets"),
        ({"facets": [[0, 1, 2, 3]]}, ValueError, "facets: expected labels"),
        ({"facets": [[0, 1, 2, 16]], "labels": [1]}, IndexError, "facets: found 16"),
        ({"facets": [[0, 1, 2, 3]], "labels": [1, 2]}, ValueError, "labels: found the shape"),
        ({"bisection_tags": np.full(24, 256)}, IndexError, "bisection_tags: found 256"),
    ],
)
def test_what_is_no_mesh_is_refused_with_a_sentence(change, kind, words):
    points, cells = box(4)
    with pytest.raises(kind, match=words):
        Mesh(**{"points": points, "cells": cells, **change})


def test_cells_that_do_not_fit_have_no_boundary():
    points = np.vstack([np.zeros(4), np.eye(4), [0.1, 0.1, 0.1, 2]])
    with pytest.raises(Error, match="pentachoron 0 does not fit its neighbors"):
        Mesh(points, [[0, 1, 2, 3, 4], [0, 1, 2, 3, 5]]).boundary()


def test_a_damaged_file_is_refused_with_its_name(tmp_path, tesseract):
    path = tmp_path / "a.pent"
    tesseract.write(path)
    data = bytearray(path.read_bytes())
    data[-1] ^= 1
    path.write_bytes(data)
    with pytest.raises(Error, match=r"a\.pent: "):
        Mesh.read(path)
    with pytest.raises(Error, match=r"none\.pent"):
        Mesh.read(tmp_path / "none.pent")
    with pytest.raises(Error, match="no/such"):
        tesseract.write("/no/such/a.pent")
    with pytest.raises(ValueError, match="zero character"):
        Mesh.read("a\0b")
    with pytest.raises(TypeError, match="path: found int"):
        Mesh.read(3)
