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
