"""Slices: closed surfaces of triangles in three dimensions."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _interop
from ._arrays import Floats, Indices, address_of, copy, floats, real, text
from ._library import Surface as CSurface
from ._library import library
from .errors import Error


_FROM_ZERO = ("speed", "strain", "force", "reaction", "energy_density")


@dataclass(frozen=True, eq=False)
class Surface:
    """A surface of triangles, counter-clockwise from outside. Its arrays are its own."""

    points: Floats  #: (vertices, 3), m, in the frame of the slice.
    triangles: Indices  #: (triangles, 3).
    ends: Indices | None = None
    """(vertices, 2): each vertex lies on the edge between these of the mesh; None where a program
    made the slice."""
    weights: Floats | None = None  #: (vertices,): this far from the first towards the second, 0..1.
    frame: Floats | None = None
    """(4, 4): rows x, y, z of the picture and the normal; the identity in three dimensions."""
    normals: Floats | None = None
    """(triangles, 3, 3): of smooth shading, unit, at each corner of each triangle; where asked."""
    attributes: dict[str, NDArray[Any]] = field(default_factory=dict)
    """Of each vertex: what pent-slice writes, as `red`, `speed`, or what a View carries to it."""

    @property
    def area(self) -> float:
        """m^2."""
        return float(np.linalg.norm(self._normals(), axis=1).sum() / 2)

    @property
    def volume(self) -> float:
        """Of what is inside, m^3."""
        corners = self.points[self.triangles[:, 0]]
        return float(np.einsum("ij,ij->", corners, self._normals()) / 6)

    def interpolate(self, values: NDArray[Any]) -> NDArray[Any]:
        """Values at the vertices of the mesh, (vertices of the mesh, ...), carried to the vertices
        of the slice. Raises a ValueError for a surface that does not know its mesh."""
        if self.ends is None or self.weights is None:
            raise ValueError("this surface does not know its mesh; one of Mesh.slice() does")
        given = np.asarray(values)
        if given.ndim == 0 or (len(self.ends) > 0 and len(given) <= int(self.ends.max())):
            shape = given.shape
            raise ValueError(f"values: found the shape {shape}; expected one a vertex of the mesh")
        far = self.weights.reshape(-1, *[1] * (given.ndim - 1))
        return np.asarray((1 - far) * given[self.ends[:, 0]] + far * given[self.ends[:, 1]])

    def color_range(self, quantity: str) -> tuple[float, float]:
        """The values of an attribute that get the first and the last color, as pent-render has
        them: w from end to end, speed, strain, force, reaction and energy_density from 0 to what a
        hundredth is above, all others from what a hundredth is below."""
        values = self._attribute(quantity)
        if len(values) == 0:
            return (0.0, 0.0)
        if quantity == "w":
            return (float(values.min()), float(values.max()))
        first, last = ((len(values) - 1) * hundredths // 100 for hundredths in (1, 99))
        ordered = np.partition(values, (first, last))
        return (0.0 if quantity in _FROM_ZERO else float(ordered[first]), float(ordered[last]))

    def colors(self, quantity: str, low: float, high: float) -> NDArray[np.float32]:
        """(vertices, 3): red, green, blue, 0..1, linear light, as pent-render colors by an
        attribute of a View's slice; `low` and `high` get the first and the last color."""
        values = floats(self._attribute(quantity), ("vertices",), "attribute")
        address = library().pent_colors(
            text(quantity, "quantity"), address_of(values), len(values), real(low, "low"),
            real(high, "high"),
        )  # fmt: skip
        return copy(address, (len(values), 3), np.float32)

    def to_trimesh(self) -> Any:
        """A trimesh.Trimesh. Raises an ImportError where trimesh is not installed."""
        return _interop.surface_to_trimesh(self)

    def to_pyvista(self) -> Any:
        """A pyvista.PolyData. Raises an ImportError where pyvista is not installed."""
        return _interop.surface_to_pyvista(self)

    def to_meshio(self) -> Any:
        """A meshio.Mesh. Raises an ImportError where meshio is not installed."""
        return _interop.surface_to_meshio(self)

    def __repr__(self) -> str:
        return f"<pentimento.Surface: {len(self.points)} vertices, {len(self.triangles)} triangles>"

    def _attribute(self, name: str) -> NDArray[Any]:
        if name not in self.attributes:
            there = ", ".join(self.attributes) or "none"
            raise Error(f"surface: has no attribute {name}; there are {there}")
        return self.attributes[name]

    def _normals(self) -> Floats:
        a, b, c = (self.points[self.triangles[:, i]] for i in range(3))
        normals: Floats = np.cross(b - a, c - a)
        return normals


def copied(seen: CSurface, normals: int | None = None) -> Surface:
    """What the library shows of a slice, copied: the next slice takes its place.

    normals  Where they are, if they were asked for.
    """
    vertices = seen.vertices
    return Surface(
        points=copy(seen.positions, (vertices, 3), np.float64),
        triangles=copy(seen.triangles, (seen.triangle_count, 3), np.uint32),
        ends=copy(seen.ends, (vertices, 2), np.uint32),
        weights=copy(seen.weights, (vertices,), np.float64),
        frame=copy(ctypes.addressof(seen) + CSurface.frame.offset, (4, 4), np.float64),
        normals=None
        if normals is None
        else copy(normals, (seen.triangle_count, 3, 3), np.float64),
    )
