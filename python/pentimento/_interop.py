"""Meshes and surfaces of other packages, where they are installed."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Error

if TYPE_CHECKING:
    from .mesh import Mesh
    from .surface import Surface

_VTK_TRIANGLE = 5
_VTK_TETRA = 10


def needed(name: str) -> Any:
    """A package that this one can do without."""
    try:
        return importlib.import_module(name)
    except ImportError:
        raise ImportError(
            f"this needs the package {name}, which is not installed: pip install {name}"
        ) from None


def _simplices(mesh: Mesh) -> tuple[Any, Any, dict[str, Any]]:
    """Points of up to three coordinates, triangles or tetrahedra, and what else points have."""
    points = np.array(mesh.points)
    data = {name: np.array(values) for name, values in mesh.vertex_fields.items()}
    if mesh.dimension < 4:
        return points, mesh.cells.astype(np.int64), data
    data["w"] = points[:, 3].copy()
    return points[:, :3], mesh.boundary().astype(np.int64), data


def mesh_to_meshio(mesh: Mesh) -> Any:
    meshio = needed("meshio")
    points, cells, data = _simplices(mesh)
    kind = "triangle" if mesh.dimension == 2 else "tetra"
    return meshio.Mesh(points, [(kind, cells)], point_data=data)


def _turned_right(points: Any, cells: Any) -> tuple[Any, Any]:
    """Cells as they are, with two corners exchanged where they are the wrong way round."""
    places = np.asarray(points, dtype=np.float64)
    corners = np.array(cells, dtype=np.int64)
    edges = places[corners[:, 1:]] - places[corners[:, :1]]
    wrong = np.linalg.det(edges) < 0
    corners[wrong, 0], corners[wrong, 1] = corners[wrong, 1], corners[wrong, 0].copy()
    return places, corners


def mesh_from_meshio(other: Any) -> tuple[Any, Any]:
    flat = np.asarray(other.points).shape[1] == 2
    kind = "triangle" if flat else "tetra"
    blocks = [block.data for block in other.cells if block.type == kind]
    if not blocks:
        raise Error(f"the meshio.Mesh has no {kind} cells; a surface becomes a body by make_mesh()")
    return _turned_right(other.points, np.concatenate(blocks))


def mesh_to_pyvista(mesh: Mesh) -> Any:
    pyvista = needed("pyvista")
    points, cells, data = _simplices(mesh)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    kind = _VTK_TRIANGLE if mesh.dimension == 2 else _VTK_TETRA
    grid = pyvista.UnstructuredGrid({kind: cells}, points)
    for name, values in data.items():
        grid.point_data[name] = values
    return grid


def mesh_from_pyvista(grid: Any) -> tuple[Any, Any]:
    cells = grid.cells_dict.get(_VTK_TETRA)
    if cells is None:
        raise Error("the grid has no tetrahedra; a surface becomes a body by make_mesh()")
    return _turned_right(grid.points, cells)


def surface_to_trimesh(surface: Surface) -> Any:
    trimesh = needed("trimesh")
    return trimesh.Trimesh(
        vertices=surface.points, faces=surface.triangles.astype(np.int64), process=False
    )


def surface_to_pyvista(surface: Surface) -> Any:
    pyvista = needed("pyvista")
    threes = np.full((len(surface.triangles), 1), 3)
    faces = np.hstack([threes, surface.triangles.astype(np.int64)])
    made = pyvista.PolyData(surface.points, faces.ravel())
    for name, values in surface.attributes.items():
        made.point_data[name] = values
    return made


def surface_to_meshio(surface: Surface) -> Any:
    meshio = needed("meshio")
    return meshio.Mesh(
        surface.points,
        [("triangle", surface.triangles.astype(np.int64))],
        point_data=dict(surface.attributes),
    )
