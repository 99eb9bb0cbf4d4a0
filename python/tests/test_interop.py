"""Meshes of other packages, where they are installed; a sentence where not."""

import importlib

import numpy as np
import pytest
from conftest import box

from pentimento import Error, Mesh

NAMES = ("meshio", "pyvista", "trimesh")


@pytest.mark.parametrize("name", NAMES)
def test_a_package_that_is_missing_is_named(cube, monkeypatch, name):
    def missing(module, *_):
        raise ImportError(module)

    monkeypatch.setattr(importlib, "import_module", missing)
    with pytest.raises(ImportError, match=f"needs the package {name}, which is not installed"):
        getattr(cube, f"to_{name}")()
    with pytest.raises(ImportError, match=f"needs the package {name}, which is not installed"):
        getattr(cube.slice(), f"to_{name}")()


@pytest.mark.parametrize("dimension", [2, 3])
def test_meshio_gives_back_what_it_got(dimension):
    pytest.importorskip("meshio")
    mesh = Mesh(*box(dimension, 2))
    other = mesh.to_meshio()
    again = Mesh.from_meshio(other)
    np.testing.assert_array_equal(again.points, mesh.points)
    np.testing.assert_array_equal(again.cells, mesh.cells)
    other.cells[0].data = other.cells[0].data[:, [1, 0, *range(2, dimension + 1)]]  # inside out
    assert Mesh.from_meshio(other).hypervolume == pytest.approx(1)
    other.cells = []
    with pytest.raises(Error, match="has no"):
        Mesh.from_meshio(other)


def test_four_dimensions_become_a_boundary_with_w(tesseract):
    pytest.importorskip("meshio")
    other = tesseract.to_meshio()
    np.testing.assert_array_equal(other.cells_dict["tetra"], tesseract.boundary())
    np.testing.assert_array_equal(other.points, tesseract.points[:, :3])
    np.testing.assert_array_equal(other.point_data["w"], tesseract.points[:, 3])
    assert len(tesseract.slice(offset=0.5).to_meshio().cells_dict["triangle"]) > 0


@pytest.mark.parametrize("dimension", [3, 4])
def test_quantities_of_vertices_go_along(dimension):
    pytest.importorskip("meshio")
    points, cells = box(dimension, 2)
    mesh = Mesh(points, cells, vertex_fields={"heat": points[:, 0], "flow": -points})
    data = mesh.to_meshio().point_data
    np.testing.assert_array_equal(data["heat"], points[:, 0])
    np.testing.assert_array_equal(data["flow"], -points)


@pytest.mark.parametrize("dimension", [2, 3])
def test_meshio_gives_back_what_is_known_of_points_and_cells(dimension):
    meshio = pytest.importorskip("meshio")
    points, cells = box(dimension, 2)
    middles = points[cells].mean(axis=1)
    mesh = Mesh(
        points,
        cells,
        regions=(middles[:, 0] > 0.5).astype(int) + 65534,
        fibers=middles,
        vertex_fields={"heat": points[:, 0], "flow": -points},
        cell_fields={"load": middles[:, 1], "push": 2 * middles},
    )
    other = mesh.to_meshio()
    other.point_data["gmsh:dim_tags"] = np.zeros((len(points), 5), int)  # nothing that a mesh has
    other.cells.append(meshio.CellBlock("line", np.array([[0, 1]])))
    for values in other.cell_data.values():
        values.append(np.zeros((1, *values[0].shape[1:])))
    again = Mesh.from_meshio(other)
    for name in ("points", "cells", "regions", "fibers"):
        np.testing.assert_array_equal(getattr(again, name), getattr(mesh, name))
    for name in ("vertex_fields", "cell_fields"):
        found, expected = getattr(again, name), getattr(mesh, name)
        assert found.keys() == expected.keys()
        for key, values in expected.items():
            np.testing.assert_array_equal(found[key], values)


def test_meshio_of_several_blocks_keeps_data_beside_its_cells():
    meshio = pytest.importorskip("meshio")
    points, cells = box(3, 2)
    blocks = [("tetra", cells[:10]), ("triangle", cells[:3, :3]), ("tetra", cells[10:])]
    labels = [np.full(10, 4), np.full(3, 9), np.full(len(cells) - 10, 5)]
    other = meshio.Mesh(points, blocks, cell_data={"gmsh:physical": labels})
    expected = [4] * 10 + [5] * (len(cells) - 10)
    np.testing.assert_array_equal(Mesh.from_meshio(other).regions, expected)


@pytest.mark.parametrize(("dimension", "kind"), [(2, "quad"), (3, "hexahedron")])
def test_cells_that_would_be_lost_are_refused(dimension, kind):
    meshio = pytest.importorskip("meshio")
    points, cells = box(dimension, 1)
    more = np.arange(2**dimension)[None]
    simplex = "triangle" if dimension == 2 else "tetra"
    other = meshio.Mesh(points, [(simplex, cells), (kind, more)])
    with pytest.raises(Error, match=f"other cells .{kind}.; write it to a file"):
        Mesh.from_meshio(other)


def test_trimesh_finds_the_same_volume(cube, tesseract):
    pytest.importorskip("trimesh")
    found = cube.to_trimesh()
    assert found.is_watertight and found.volume == pytest.approx(1)
    surface = tesseract.slice(offset=0.5)
    assert surface.to_trimesh().volume == pytest.approx(surface.volume)
    assert surface.to_trimesh().area == pytest.approx(surface.area)
    with pytest.raises(Error, match="is no surface"):
        tesseract.to_trimesh()


def test_pyvista_finds_the_same_volume(cube, tesseract):
    pytest.importorskip("pyvista")
    grid = cube.to_pyvista()
    assert grid.volume == pytest.approx(1)
    assert Mesh.from_pyvista(grid).hypervolume == pytest.approx(1)
    assert tesseract.to_pyvista().n_cells == len(tesseract.boundary())
    assert Mesh(*box(2)).to_pyvista().n_cells == 2
    assert tesseract.slice(offset=0.5).to_pyvista().volume == pytest.approx(1)
