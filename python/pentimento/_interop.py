"""Meshes and surfaces of other packages, where they are installed."""

from __future__ import annotations

import importlib
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Error

if TYPE_CHECKING:
    from .mesh import Mesh
    from .surface import Surface

_VTK_TRIANGLE = 5
_VTK_TETRA = 10

_REGIONS = ("region", "gmsh:physical", "medit:ref")
_FIBERS = "fiber"  # as pent-mesh reads them, too


def needed(name: str) -> Any:
    """A package that this one can do without."""
    try:
        return importlib.import_module(name)
    except ImportError:
        raise ImportError(
            f"this needs the package {name}, which is not installed: pip install {name}"
        ) from None


def _simplices(mesh: Mesh) -> tuple[Any, Any, dict[str, Any], dict[str, Any]]:
    """Points of up to three coordinates, triangles or tetrahedra, and what else points and these
    have."""
    points = np.array(mesh.points)
    data = {name: np.array(values) for name, values in mesh.vertex_fields.items()}
    if mesh.dimension == 4:
        data["w"] = points[:, 3].copy()
        return points[:, :3], mesh.boundary().astype(np.int64), data, {}
    of_cells = {name: np.array(values) for name, values in mesh.cell_fields.items()}
    if mesh.regions is not None:
        of_cells[_REGIONS[0]] = mesh.regions.astype(np.int32)
    if mesh.fibers is not None:
        of_cells[_FIBERS] = np.array(mesh.fibers)
    return points, mesh.cells.astype(np.int64), data, of_cells


def mesh_to_meshio(mesh: Mesh) -> Any:
    meshio = needed("meshio")
    points, cells, data, of_cells = _simplices(mesh)
    kind = "triangle" if mesh.dimension == 2 else "tetra"
    return meshio.Mesh(
        points,
        [(kind, cells)],
        point_data=data,
        cell_data={name: [values] for name, values in of_cells.items()},
    )


def _turned_right(points: Any, cells: Any) -> tuple[Any, Any]:
    """Cells as they are, with two corners exchanged where they are the wrong way round."""
    places = np.asarray(points, dtype=np.float64)
    corners = np.array(cells, dtype=np.int64)
    edges = places[corners[:, 1:]] - places[corners[:, :1]]
    wrong = np.linalg.det(edges) < 0
    corners[wrong, 0], corners[wrong, 1] = corners[wrong, 1], corners[wrong, 0].copy()
    return places, corners


def _fields(data: Mapping[str, Any], dimension: int, reserved: set[str]) -> dict[str, Any]:
    """Of the data those that a mesh may have: real numbers, or vectors, by a name that it takes."""
    found = {}
    for name, values in data.items():
        numbers = np.asarray(values)
        is_one = numbers.ndim == 1 or numbers.shape[1:] == (dimension,)
        is_named = re.fullmatch("[A-Za-z0-9_]+", name) and name not in reserved
        if is_one and is_named and numbers.dtype.kind in "iuf" and np.isfinite(numbers).all():
            found[name] = numbers
    return found


def _carried(
    points: Any, cells: Any, of_points: Mapping[str, Any], of_cells: Mapping[str, Any]
) -> dict[str, Any]:
    """The arguments of a Mesh."""
    places, corners = _turned_right(points, cells)
    dimension = places.shape[1]
    axes = "xyzw"[:dimension]
    vertex_names = {"column", "layer", *(kind + axis for kind in ("", "v", "f") for axis in axes)}
    cell_names = {"region", "parent", "bisection_tag", _FIBERS, *(f"{_FIBERS}_{a}" for a in axes)}
    cell_names |= {f"v{corner}" for corner in range(dimension + 1)}
    made = {
        "points": places,
        "cells": corners,
        "vertex_fields": _fields(of_points, dimension, vertex_names),
        "cell_fields": _fields(of_cells, dimension, cell_names),
    }
    labels = [np.asarray(of_cells[name]) for name in _REGIONS if name in of_cells]
    for one in labels[:1]:
        if one.ndim == 1 and (one == np.clip(one, 0, 65535).astype(np.uint16)).all():
            made["regions"] = one.astype(np.uint16)
    fibers = np.asarray(of_cells.get(_FIBERS, ()))
    if fibers.shape == (len(corners), dimension):
        made["fibers"] = fibers
    return made


def mesh_from_meshio(other: Any) -> dict[str, Any]:
    dimension = np.asarray(other.points).shape[1]
    kind = "triangle" if dimension == 2 else "tetra"
    blocks = [number for number, block in enumerate(other.cells) if block.type == kind]
    beside = {block.type for block in other.cells if block.dim >= dimension and block.type != kind}
    if beside:
        raise Error(
            f"the meshio.Mesh has other cells ({', '.join(sorted(beside))}); write it to a file,"
            " which make_mesh() reads and cuts"
        )
    if not blocks:
        raise Error(f"the meshio.Mesh has no {kind} cells; a surface becomes a body by make_mesh()")
    of_cells = {
        name: np.concatenate([np.asarray(values[number]) for number in blocks])
        for name, values in other.cell_data.items()
    }
    cells = np.concatenate([other.cells[number].data for number in blocks])
    return _carried(other.points, cells, other.point_data, of_cells)


def mesh_to_pyvista(mesh: Mesh) -> Any:
    pyvista = needed("pyvista")
    points, cells, data, _ = _simplices(mesh)
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
