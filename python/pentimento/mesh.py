"""Meshes of bodies: triangles, tetrahedra or pentachora, as `.pent` files have them."""

from __future__ import annotations

import ctypes
import html
import math
import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _interop
from ._arrays import Floats, Indices, address_of, copy, floats, indices, real, text, view
from ._library import Field, Handle, MeshArrays, MeshExtras, MeshInfo, library
from ._library import Surface as CSurface
from ._rotations import Rotations, hyperplane
from ._version import __version__
from .errors import Error
from .surface import Surface, copied

Path = str | os.PathLike[str]

_CELLS = {2: "triangles", 3: "tetrahedra", 4: "pentachora"}


class Mesh:
    """A mesh of simplices in two, three or four dimensions that is valid, and never changes.

    Its arrays are read-only views of the library's, without a copy. They stay valid as long as
    anybody has one, also without the mesh.
    """

    __slots__ = ("_handle", "_info", "_extras", "report", "__weakref__")

    report: dict[str, Any] | None
    """What pent-mesh reported, of a mesh that make_mesh() made."""

    def __init__(
        self,
        points: ArrayLike,
        cells: ArrayLike,
        *,
        regions: ArrayLike | None = None,
        columns: ArrayLike | None = None,
        layers: ArrayLike | None = None,
        parents: ArrayLike | None = None,
        fibers: ArrayLike | None = None,
        vertex_fields: Mapping[str, ArrayLike] | None = None,
        cell_fields: Mapping[str, ArrayLike] | None = None,
        facets: ArrayLike | None = None,
        labels: ArrayLike | None = None,
        base_labels: ArrayLike | None = None,
        bisection_tags: ArrayLike | None = None,
    ) -> None:
        """A mesh of arrays, which are copied.

        points   (vertices, dimension), m; dimension 2, 3 or 4.
        cells    (cells, dimension + 1), from 0, each positively oriented and not degenerate.
        regions  (cells,), labels 0 to 65535, free to use.
        columns, layers  (vertices,): from which vertex of the base each was extruded, and in which
                         layer.
        parents  (cells,): which quadratic cell each is a child of.
        fibers   (cells, dimension): directions, of any length; zero for none.

        Beside the mesh, for files and for who looks at it:

        vertex_fields, cell_fields  Quantities by their names, of letters, digits and "_": an array
                         (vertices,) or (cells,) each, or with a column an axis for a vector.
        facets   (facets, dimension): those of the boundary that have labels, outward.
        labels, base_labels  (facets,), 0 to 65535: theirs, and what the base mesh has there.
        bisection_tags  (cells,), 0 to 255.

        Raises a TypeError or ValueError for arrays of other kinds or shapes, an IndexError for
        numbers out of range, and an Error for cells that are not valid.
        """
        places = floats(points, ("vertices", "dimension"), "points")
        dimension = places.shape[1]
        if dimension not in _CELLS:
            raise ValueError(f"points: found {dimension} columns; expected 2, 3 or 4")
        count = len(places)
        corners = indices(cells, ("cells", dimension + 1), "cells", max(count, 1))
        per_cell: tuple[int | str, ...] = (len(corners),)
        optional: dict[str, NDArray[Any] | None] = {
            "regions": _labels(regions, per_cell, "regions", np.uint16),
            "columns": _labels(columns, (count,), "columns", np.uint32),
            "layers": _labels(layers, (count,), "layers", np.uint32),
            "parents": _labels(parents, per_cell, "parents", np.uint32),
            "fibers": None if fibers is None else floats(fibers, (*per_cell, dimension), "fibers"),
        }
        arrays = MeshArrays(
            address_of(places),
            count,
            address_of(corners),
            len(corners),
            *[address_of(array) for array in optional.values()],
        )
        beside = _Beside(dimension, count, len(corners))
        beside.add_fields("vertex", vertex_fields)
        beside.add_fields("cell", cell_fields)
        beside.add_facets(facets, labels, base_labels)
        beside.add("bisection_tags", _labels(bisection_tags, per_cell, "bisection_tags", np.uint8))
        self._take(
            library().pent_store_mesh(dimension, ctypes.byref(arrays), ctypes.byref(beside.extras))
        )

    @classmethod
    def read(cls, path: Path) -> Mesh:
        """A mesh from a `.pent` file. Raises an Error that says what is wrong with the file."""
        made = cls.__new__(cls)
        made._take(library().pent_read_mesh(path_bytes(path)))
        return made

    def _take(self, number: int) -> None:
        self._handle = Handle(number, library().pent_free_mesh)
        self._info = MeshInfo()
        self._extras = MeshExtras()
        self.report = None
        library().pent_mesh_info_of(number, ctypes.byref(self._info))
        library().pent_mesh_extras_of(number, ctypes.byref(self._extras))

    def write(self, path: Path, *, ascii: bool = False, created_by: str | None = None) -> None:
        """Writes a `.pent` file, by default in the name of the program that made the mesh.

        What is beside the mesh goes along: quantities, labels of the boundary, tags of bisection.
        The same mesh, name and kind give the same bytes. Raises an Error where the file cannot be
        written; there is none then.
        """
        name = self.created_by or f"pentimento {__version__}" if created_by is None else created_by
        library().pent_write_mesh(
            self._handle.number, path_bytes(path), text(name, "created_by"), int(bool(ascii))
        )

    @property
    def dimension(self) -> int:
        """2, 3 or 4."""
        return int(self._info.dimension)

    @property
    def vertex_count(self) -> int:
        """How many vertices there are."""
        return int(self._info.arrays.vertices)

    @property
    def cell_count(self) -> int:
        """How many cells there are: triangles, tetrahedra or pentachora."""
        return int(self._info.arrays.cell_count)

    @property
    def created_by(self) -> str:
        """Program and version that wrote the file; "" for a mesh of arrays."""
        return str(self._info.created_by.decode("utf-8", "replace"))

    @property
    def crc32c(self) -> int:
        """The checksum that the file states; 0 for a mesh of arrays."""
        return int(self._info.crc32c)

    @property
    def points(self) -> Floats:
        """(vertices, dimension), m."""
        return self._seen("positions", (self.vertex_count, self.dimension), np.float64)

    @property
    def cells(self) -> Indices:
        """(cells, dimension + 1), from 0."""
        return self._seen("cells", (self.cell_count, self.dimension + 1), np.uint32)

    @property
    def regions(self) -> NDArray[np.uint16] | None:
        """(cells,), or None."""
        return self._optional("regions", (self.cell_count,), np.uint16)

    @property
    def columns(self) -> Indices | None:
        """(vertices,), or None."""
        return self._optional("columns", (self.vertex_count,), np.uint32)

    @property
    def layers(self) -> Indices | None:
        """(vertices,), or None."""
        return self._optional("layers", (self.vertex_count,), np.uint32)

    @property
    def parents(self) -> Indices | None:
        """(cells,), or None."""
        return self._optional("parents", (self.cell_count,), np.uint32)

    @property
    def fibers(self) -> Floats | None:
        """(cells, dimension), or None."""
        return self._optional("fibers", (self.cell_count, self.dimension), np.float64)

    @property
    def vertex_fields(self) -> dict[str, Floats]:
        """Quantities of the vertices by their names: (vertices,), or (vertices, dimension) for
        vectors."""
        return self._fields("vertex", self.vertex_count)

    @property
    def cell_fields(self) -> dict[str, Floats]:
        """Quantities of the cells by their names: (cells,), or (cells, dimension) for vectors."""
        return self._fields("cell", self.cell_count)

    @property
    def facets(self) -> Indices | None:
        """Facets of the boundary that have labels, outward, (facets, dimension), or None;
        boundary() has all."""
        return self._beside("facets", (self._extras.facet_count, self.dimension), np.uint32)

    @property
    def labels(self) -> NDArray[np.uint16] | None:
        """(facets,), or None. What space-time bodies mean by 1 to 5: docs/pent-format.md."""
        return self._beside("labels", (self._extras.facet_count,), np.uint16)

    @property
    def base_labels(self) -> NDArray[np.uint16] | None:
        """(facets,): what the base mesh has there, or None."""
        return self._beside("base_labels", (self._extras.facet_count,), np.uint16)

    @property
    def bisection_tags(self) -> NDArray[np.uint8] | None:
        """(cells,), or None."""
        return self._beside("bisection_tags", (self.cell_count,), np.uint8)

    @property
    def hypervolume(self) -> float:
        """Sum of the cells, m^dimension."""
        return float(self._info.hypervolume)

    @property
    def box(self) -> Floats:
        """(2, dimension): the lowest and the highest coordinates, m."""
        return np.array([self.points.min(axis=0), self.points.max(axis=0)])

    def boundary(self) -> Indices:
        """The facets of its boundary, outward, (facets, dimension); found once, then a view.

        Raises an Error where cells do not fit together.
        """
        count = ctypes.c_int64()
        address = library().pent_mesh_boundary(self._handle.number, ctypes.byref(count))
        return view(address, (count.value, self.dimension), np.uint32, self._handle)

    def slice(
        self,
        normal: ArrayLike | None = None,
        offset: float = 0.0,
        points: ArrayLike | None = None,
        *,
        rotate: Rotations | None = None,
        shading: bool = False,
    ) -> Surface:
        """The slice by the hyperplane normal . x = offset, in m, by default w = offset; in three
        dimensions the whole surface, whatever normal, offset and rotations.

        points   (vertices, dimension): where its vertices are instead of at rest, m.
        rotate   In place of a normal: the mesh turned about the origin first, as in "xw:30", in
                 degrees, or several: ["xw:30", "yz:10"] or {"xw": 30, "yz": 10}, in this order. To
                 the bit what pent-slice makes.
        shading  Whether Surface.normals are wanted. Not with a normal.

        Raises an Error for a normal that is zero, numbers that are not finite, or a mesh in two
        dimensions; a ValueError for rotations that are not understood.
        """
        shape = (self.vertex_count, self.dimension)
        places = address_of(None if points is None else floats(points, shape, "points"))
        seen = CSurface()
        if normal is None:
            plane = hyperplane(rotate, real(offset, "offset"))
            normals = ctypes.c_void_p()
            wanted = ctypes.byref(normals) if shading else None
            library().pent_slice_turned(
                self._handle.number, places, ctypes.byref(plane), ctypes.byref(seen), wanted
            )
            return copied(seen, normals.value or 0 if shading else None)
        if rotate is not None or shading:
            raise ValueError("normal: not together with rotate or shading")
        across = None if self.dimension == 3 else floats(normal, (4,), "normal")
        library().pent_slice_mesh(
            self._handle.number, places, address_of(across), real(offset, "offset"),
            ctypes.byref(seen),
        )  # fmt: skip
        return copied(seen)

    def strain(self, points: ArrayLike) -> Floats:
        """(vertices,): how much the cells around each vertex are strained with the vertices at
        `points`, (vertices, dimension), m: the mean of the Frobenius norm of the Green strain, by
        their volume. Raises an Error for a mesh in two dimensions."""
        places = floats(points, (self.vertex_count, self.dimension), "points")
        address = library().pent_mesh_strain(self._handle.number, address_of(places))
        found: Floats = copy(address, (self.vertex_count,), np.float64)
        return found

    def quantities(self) -> dict[str, Floats]:
        """All quantities at the vertices: vertex_fields, and of cell_fields of other names the mean
        over the cells at each vertex by their volume. What a View has of the mesh. Raises an Error
        for cell_fields of a mesh in two dimensions."""
        found = self.vertex_fields
        for name, values in self.cell_fields.items():
            if name not in found:
                rows = 1 if values.ndim == 1 else values.shape[1]
                means = library().pent_mesh_means(self._handle.number, address_of(values), rows)
                found[name] = copy(means, (self.vertex_count, *values.shape[1:]), np.float64)
        return found

    def cell_hypervolumes(self) -> Floats:
        """(cells,), m^dimension, all above 0."""
        determinants: Floats = np.linalg.det(self._edges())
        return determinants / math.factorial(self.dimension)

    def quality(self) -> Floats:
        """(cells,): the mean ratio of each, 1 for a regular simplex and 0 for a flat one.

        c V^(2/d) / (mean squared edge), with c such that the regular simplex of dimension d has 1;
        what `pent-check` calls quality.
        """
        d = self.dimension
        edges = self._edges()
        first, second = np.triu_indices(d, 1)
        between = edges[:, second] - edges[:, first]
        squares = (edges**2).sum(axis=(1, 2)) + (between**2).sum(axis=(1, 2))
        mean = squares / (d * (d + 1) / 2)
        regular = math.sqrt(d + 1) / (math.factorial(d) * 2 ** (d / 2))  # volume at edge 1
        ratio: Floats = (self.cell_hypervolumes() / regular) ** (2 / d) / mean
        return ratio

    def to_meshio(self) -> Any:
        """A meshio.Mesh: of triangles or tetrahedra in two or three dimensions, with cell_fields,
        the regions as "region" and fibers as "fiber", of the boundary's tetrahedra with w as point
        data in four; vertex_fields are point data. Raises an ImportError where it is not
        installed."""
        return _interop.mesh_to_meshio(self)

    @classmethod
    def from_meshio(cls, other: Any) -> Mesh:
        """The tetrahedra of a meshio.Mesh, or its triangles where it has points of the plane, with
        what a mesh may have of its data: numbers and vectors by names of letters, digits and "_",
        regions out of "region", "gmsh:physical" or "medit:ref", fibers out of "fiber". Points,
        lines, and in space surfaces, are left out. Raises an Error for other cells, as hexahedra:
        make_mesh() cuts those of files."""
        return cls(**_interop.mesh_from_meshio(other))

    def to_pyvista(self) -> Any:
        """A pyvista.UnstructuredGrid, as to_meshio(), without data of cells. Raises an ImportError
        where it is not installed."""
        return _interop.mesh_to_pyvista(self)

    @classmethod
    def from_pyvista(cls, grid: Any) -> Mesh:
        """The tetrahedra of a pyvista.UnstructuredGrid."""
        return cls(*_interop.mesh_from_pyvista(grid))

    def to_trimesh(self) -> Any:
        """The surface of a mesh in three dimensions as a trimesh.Trimesh. Raises an ImportError
        where it is not installed. To go back: make_mesh((other.vertices, other.faces))."""
        if self.dimension != 3:
            raise Error(f"a mesh of {self.dimension} dimensions is no surface; slice() gives one")
        return self.slice().to_trimesh()

    def __reduce__(self) -> tuple[Any, ...]:
        others = {name: getattr(self, name) for name in _OTHERS}
        return _unpickled, (np.array(self.points), np.array(self.cells), others)

    def __repr__(self) -> str:
        return (
            f"<pentimento.Mesh: {self.dimension}D, {self.vertex_count} vertices,"
            f" {self.cell_count} {_CELLS[self.dimension]}>"
        )

    def _repr_png_(self) -> bytes | None:
        from . import _look

        return _look.picture_of(self)

    def _repr_html_(self) -> str:
        from . import _look

        rows = {
            "vertices": str(self.vertex_count),
            _CELLS[self.dimension]: str(self.cell_count),
            "hypervolume": f"{self.hypervolume:.6g} m^{self.dimension}",
            "box": " x ".join(f"{side:.4g}" for side in self.box[1] - self.box[0]) + " m",
        }
        return html_table("Mesh", rows) + _look.html_picture(self._repr_png_())

    def _seen(self, name: str, shape: tuple[int, ...], dtype: type[Any]) -> NDArray[Any]:
        return view(getattr(self._info.arrays, name), shape, dtype, self._handle)

    def _optional(
        self, name: str, shape: tuple[int, ...], dtype: type[Any]
    ) -> NDArray[Any] | None:
        return None if getattr(self._info.arrays, name) is None else self._seen(name, shape, dtype)

    def _beside(
        self, name: str, shape: tuple[int, ...], dtype: type[Any]
    ) -> NDArray[Any] | None:
        address = getattr(self._extras, name)
        return None if address is None else view(address, shape, dtype, self._handle)

    def _fields(self, of: str, count: int) -> dict[str, Floats]:
        found: dict[str, Floats] = {}
        fields = getattr(self._extras, f"{of}_fields")
        for number in range(getattr(self._extras, f"{of}_field_count")):
            name, values = seen_field(fields[number], count, self._handle)
            found[name] = values
        return found

    def _edges(self) -> Floats:
        corners = self.points[self.cells]
        edges: Floats = corners[:, 1:] - corners[:, :1]
        return edges


def c_arrays(mesh: Mesh) -> MeshArrays:
    """As the C interface takes a mesh; valid as long as the mesh is."""
    arrays: MeshArrays = mesh._info.arrays
    return arrays


def seen_field(field: Field, count: int, owner: Handle) -> tuple[str, Floats]:
    """The name of a quantity, and a view of it: (count,), or (count, rows) for vectors."""
    shape = (count,) if field.rows == 1 else (count, field.rows)
    return field.name.decode("utf-8", "replace"), view(field.values, shape, np.float64, owner)


def path_bytes(path: Path) -> bytes:
    """A path as C has it. Raises a TypeError or a ValueError for what is none."""
    try:
        name = os.fsencode(path)
    except TypeError:
        raise TypeError(f"path: found {type(path).__name__}; expected text or a Path") from None
    if b"\0" in name:
        raise ValueError("path: has a zero character in it")
    return name


def html_table(title: str, rows: dict[str, str]) -> str:
    """A table for notebooks."""
    cells = "".join(
        f"<tr><th>{html.escape(key)}</th><td>{html.escape(value)}</td></tr>"
        for key, value in rows.items()
    )
    return f"<table><caption>{html.escape(title)}</caption>{cells}</table>"


def _labels(
    value: ArrayLike | None,
    shape: tuple[int | str, ...],
    name: str,
    dtype: type[np.unsignedinteger[Any]],
) -> NDArray[Any] | None:
    if value is None:
        return None
    return indices(value, shape, name, int(np.iinfo(dtype).max) + 1, dtype)


_OTHERS = (
    "regions", "columns", "layers", "parents", "fibers", "vertex_fields", "cell_fields", "facets",
    "labels", "base_labels", "bisection_tags",
)  # fmt: skip


def _unpickled(points: Floats, cells: Indices, others: dict[str, Any]) -> Mesh:
    return Mesh(points, cells, **others)


class _Beside:
    """What is beside a mesh as the C interface takes it, and the arrays behind it."""

    def __init__(self, dimension: int, vertices: int, cells: int) -> None:
        self.extras = MeshExtras()
        self._dimension = dimension
        self._counts = {"vertex": vertices, "cell": cells}
        self._kept: list[Any] = []

    def add(self, name: str, array: NDArray[Any] | None) -> None:
        self._kept.append(array)
        setattr(self.extras, name, address_of(array))

    def add_fields(self, of: str, fields: Mapping[str, ArrayLike] | None) -> None:
        given = {} if fields is None else dict(fields)
        c_fields = (Field * len(given))()
        for c_field, (name, values) in zip(c_fields, given.items()):
            label = f"{of}_fields[{name!r}]"
            columns = (self._dimension,) if np.ndim(values) == 2 else ()
            array = floats(values, (self._counts[of], *columns), label)
            self._kept.append(array)
            c_field.name = text(name, f"a name of {of}_fields")
            c_field.values = address_of(array)
            c_field.rows = array.shape[1] if array.ndim == 2 else 1
        setattr(self.extras, f"{of}_fields", c_fields)
        setattr(self.extras, f"{of}_field_count", len(given))

    def add_facets(
        self, facets: ArrayLike | None, labels: ArrayLike | None, base_labels: ArrayLike | None
    ) -> None:
        if facets is None:
            if labels is not None or base_labels is not None:
                raise ValueError("labels: expected facets, which they are of")
            return
        if labels is None:
            raise ValueError("facets: expected labels, one each")
        corners = indices(
            facets, ("facets", self._dimension), "facets", max(self._counts["vertex"], 1)
        )
        count = len(corners)
        self.add("facets", corners)
        self.extras.facet_count = count
        self.add("labels", _labels(labels, (count,), "labels", np.uint16))
        self.add("base_labels", _labels(base_labels, (count,), "base_labels", np.uint16))
