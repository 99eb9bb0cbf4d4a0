"""What is to be seen of a simulation."""

from __future__ import annotations

import ctypes
import os
import threading
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _library
from ._arrays import Floats, Indices, address_of, floats, real, text, view, whole
from ._library import Handle, library
from .errors import Error
from .mesh import Mesh, c_arrays
from .reports import BodyPoint, Energy, Hit
from .scene import Scene
from .surface import Surface, copied

BodyLike = int | str  #: A body by its number, from 0, or its name.


class _Turn:
    """One thread at a time: another is refused."""

    __slots__ = ("_lock",)

    def __init__(self) -> None:
        self._lock = threading.Lock()

    def __enter__(self) -> None:
        if not self._lock.acquire(blocking=False):
            raise Error("another thread is using this simulation; take turns")

    def __exit__(self, *_: object) -> None:
        self._lock.release()


_CONTACTS = np.dtype(
    [
        ("first", np.int32),
        ("second", np.int32),
        ("is_obstacle", np.int32),
        ("distance", np.float64),
        ("force", np.float64, 4),
    ],
    align=True,
)


class Sight:
    """A simulation, and all that is to be seen of it; Simulation has what is done to it."""

    def __init__(self, scene: Scene, *, threads: int | None = None) -> None:
        """threads  1 to 1024; by default the number of cores. Results do not depend on it.

        Raises an Error with the line of pent-sim if the scene cannot be simulated."""
        self._turn = _Turn()
        count = whole(threads, 1, 1024, "threads") if threads is not None else os.cpu_count() or 1
        meshes = [scene.mesh(body) for body in scene.bodies]
        for mesh in meshes:
            require_dimension(mesh, scene.dimension)
        arrays = (_library.MeshArrays * len(meshes))(*[c_arrays(mesh) for mesh in meshes])
        opened = library().pent_open_scene(*scene._source, arrays, len(meshes), count)
        self._handle = Handle(opened, library().pent_close)
        self._number = opened
        self._kept: Handle | None = None
        self._dimension = scene.dimension

    # What is there.

    @property
    def dimension(self) -> int:
        """3 or 4."""
        return self._dimension

    @property
    def time_step(self) -> float:
        """s."""
        with self._turn:
            return float(library().pent_time_step(self._number))

    @property
    def time(self) -> float:
        """s."""
        with self._turn:
            return float(library().pent_time(self._number))

    @property
    def bodies(self) -> tuple[str, ...]:
        """Their names, in order."""
        with self._turn:
            count = library().pent_body_count(self._number)
            names = [library().pent_body_name(self._number, body) for body in range(count)]
            return tuple(name.decode("utf-8", "surrogateescape") for name in names)

    @property
    def obstacle_count(self) -> int:
        """How many obstacles there are."""
        with self._turn:
            return int(library().pent_obstacle_count(self._number))

    def vertex_count(self, body: BodyLike = 0) -> int:
        """How many vertices a body has."""
        with self._turn:
            return int(library().pent_vertex_count(self._number, self._body(body)))

    def cell_count(self, body: BodyLike = 0) -> int:
        """How many cells a body has, pentachora or tetrahedra."""
        with self._turn:
            return int(library().pent_cell_count(self._number, self._body(body)))

    def cells(self, body: BodyLike = 0) -> Indices:
        """(cells, dimension + 1): a view."""
        with self._turn:
            number = self._body(body)
            count = library().pent_cell_count(self._number, number)
            address = library().pent_cells(self._number, number)
            return view(address, (count, self._dimension + 1), np.uint32, self._keep())

    def rest_positions(self, body: BodyLike = 0) -> Floats:
        """(vertices, dimension), m, as placed: a view."""
        return self._vertices("pent_rest_positions", body)

    def positions(self, body: BodyLike = 0) -> Floats:
        """(vertices, dimension), m: a view."""
        return self._vertices("pent_positions", body)

    def velocities(self, body: BodyLike = 0) -> Floats:
        """(vertices, dimension), m/s: a view."""
        return self._vertices("pent_velocities", body)

    def forces(self, body: BodyLike = 0) -> Floats:
        """(vertices, dimension), N, of all that has an energy: a view."""
        return self._vertices("pent_forces", body)

    def masses(self, body: BodyLike = 0) -> Floats:
        """(vertices,), kg: a view."""
        with self._turn:
            number = self._body(body)
            count = library().pent_vertex_count(self._number, number)
            address = library().pent_masses(self._number, number)
            return view(address, (count,), np.float64, self._keep())

    def boundary(self, body: BodyLike = 0) -> Indices:
        """The facets of its boundary, outward, (facets, dimension); found once, then a view."""
        with self._turn:
            count = ctypes.c_int64()
            number = self._body(body)
            address = library().pent_boundary(self._number, number, ctypes.byref(count))
            return view(address, (count.value, self._dimension), np.uint32, self._keep())

    def is_asleep(self, body: BodyLike = 0) -> bool:
        """Whether a body sleeps now; none does without `[sleep]`."""
        with self._turn:
            return bool(library().pent_is_asleep(self._number, self._body(body)))

    def slice(
        self,
        body: BodyLike = 0,
        normal: ArrayLike = (0.0, 0.0, 0.0, 1.0),
        offset: float = 0.0,
    ) -> Surface:
        """The slice of a body by the hyperplane normal . x = offset, m; in three dimensions its
        whole surface, whatever normal and offset. A copy. After turns, or with smooth normals, it
        is `mesh.slice(offset=offset, points=simulation.positions(body), rotate=turns,
        shading=True)` of the body's mesh."""
        across = None if self._dimension == 3 else floats(normal, (4,), "normal")
        height = real(offset, "offset")
        with self._turn:
            seen = _library.Surface()
            library().pent_slice(
                self._number, self._body(body), address_of(across), height, ctypes.byref(seen)
            )
            return copied(seen)

    def pick(
        self,
        origin: ArrayLike,
        direction: ArrayLike,
        normal: ArrayLike | None = None,
        offset: float = 0.0,
    ) -> Hit | None:
        """The point of the bodies that a ray comes to first; None if there is none.

        origin, direction  (dimension,), m.
        normal, offset     Of the hyperplane of a slice: the ray's shadow on it counts; None for the
                           ray as it is.
        """
        shape = (self._dimension,)
        start = floats(origin, shape, "origin")
        way = floats(direction, shape, "direction")
        across = None if normal is None else floats(normal, shape, "normal")
        height = real(offset, "offset")
        hit = _library.Hit()
        with self._turn:
            found = library().pent_pick(
                self._number,
                address_of(across),
                height,
                address_of(start),
                address_of(way),
                ctypes.byref(hit),
            )
        if not found:
            return None
        point = hit.point
        weights = tuple(point.weights[: self._dimension + 1])
        place = np.array(hit.place[: self._dimension])
        return Hit(BodyPoint(point.body, point.cell, weights), place, hit.distance)

    def contacts(self) -> NDArray[Any]:
        """All contacts as they are now, an array of records; a copy.

        first        Body.
        second       Body, or obstacle where `is_obstacle`; the same as `first` within a body.
        is_obstacle  0 or 1.
        distance     Signed, m.
        force        (4,), on the first body, N; the last number is 0 in three dimensions.
        """
        with self._turn:
            count = ctypes.c_int64()
            address = library().pent_contacts(self._number, ctypes.byref(count))
            raw = ctypes.string_at(address, count.value * _CONTACTS.itemsize)
            return np.frombuffer(raw, _CONTACTS).copy()

    def energies(self) -> list[Energy]:
        """All parts of the energy, as they are now."""
        with self._turn:
            count = ctypes.c_int64()
            address = library().pent_energies(self._number, ctypes.byref(count))
            parts = (_library.Energy * count.value).from_address(address)
            return [Energy(part.name.decode(), part.energy, bool(part.is_stored)) for part in parts]

    # Below, `_turn` is taken.

    def _keep(self) -> Handle:
        """Who owns the arrays of now."""
        if self._kept is None:
            self._kept = Handle(library().pent_keep(self._number), library().pent_free_kept)
        return self._kept

    def _body(self, body: BodyLike) -> int:
        if isinstance(body, str):
            return int(library().pent_find_body(self._number, text(body, "body")))
        return whole(body, -(2**31), 2**31 - 1, "body")

    def _vertices(self, function: str, body: BodyLike) -> Floats:
        with self._turn:
            number = self._body(body)
            count = library().pent_vertex_count(self._number, number)
            address = getattr(library(), function)(self._number, number)
            return view(address, (count, self._dimension), np.float64, self._keep())


def require_dimension(mesh: Mesh, dimension: int) -> None:
    if mesh.dimension != dimension:
        raise Error(f"a mesh of {mesh.dimension} dimensions was given; the scene has {dimension}")
