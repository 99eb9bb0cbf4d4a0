"""A scene in motion."""

from __future__ import annotations

import ctypes
import os
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from types import TracebackType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _library, _toml
from ._arrays import Floats, Indices, address_of, floats, indices, real, text, view, whole
from ._library import Handle, library
from ._progress import counted
from .errors import Error
from .mesh import Mesh, c_arrays
from .scene import Scene
from .surface import Surface, copied

_BodyLike = int | str


class StepReport(NamedTuple):
    """What one step did."""

    step: int  #: Steps taken so far.
    time: float  #: s.
    seconds: float  #: Spent on it.
    substeps: int  #: 1, or more where the step had to be cut.
    refused: int  #: Attempts that were thrown away.
    newton_iterations: int  #: Behind the first, linear step.
    iterations: int  #: Of the linear solver.
    residual: float  #: Of the linear solver, relative.
    unknowns: int  #: Scalars solved for.
    inverted: int  #: Cells turned inside out.
    asleep: int  #: Bodies that sleep.
    point_facet: int  #: Vertices in contact with facets of bodies.
    mixed: int  #: Edges in contact with triangles (with edges in 3D).
    obstacle: int  #: Vertices in contact with obstacles.
    deepest: float  #: Deepest penetration of a vertex, m.
    smallest_distance: float  #: Signed, m; infinite where nothing touches.


class Energy(NamedTuple):
    """A part of the energy."""

    name: str  #: "kinetic", "elastic", "gravity", "contact" and so on.
    energy: float  #: J.
    is_stored: bool  #: False for what cannot be had back.


class BodyPoint(NamedTuple):
    """A point of a body: barycentric coordinates in a cell."""

    body: int
    cell: int
    weights: tuple[float, ...]  #: dimension + 1 of them, of the sum 1.


class Hit(NamedTuple):
    """What a ray meets."""

    point: BodyPoint
    place: Floats  #: (dimension,), m.
    distance: float  #: From the ray's origin, m.


class State:
    """All that goes from one step of a simulation to the next, kept in memory."""

    __slots__ = ("_handle",)

    def __init__(self, handle: Handle) -> None:
        self._handle = handle


@dataclass(frozen=True)
class Grab:
    """A spring that holds a point of a body to an anchor."""

    simulation: Simulation
    number: int

    def move(self, anchor: ArrayLike) -> None:
        """Takes the anchor to (dimension,), m, by the end of the next step."""
        self.simulation._move_grab(self.number, anchor)

    def remove(self) -> None:
        """Lets go. Raises an Error if it has been removed."""
        self.simulation._remove_grab(self.number)


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


class Simulation:
    """A scene in motion, which you step. A context manager: it is closed at the end of `with`.

    A body is named by its number, from 0, or its name. Lengths are in m, velocities in m/s, forces
    in N, energies in J, times in s.

    Arrays of vertices and cells are read-only views of the library's own: they show the state as it
    is when you look, through all steps; `.copy()` keeps what they show now. When bodies or obstacles
    come or go, or the simulation is closed, a view stays valid and shows what was there last. While
    another thread steps a view may show some vertices before and some after the step.

    Steps run without the interpreter's lock. A simulation is for one thread at a time, another is
    refused with an Error; different simulations may be used at once. Ctrl-C stops between two
    steps. What is refused has changed nothing.
    """

    def __init__(self, scene: Scene, *, threads: int | None = None) -> None:
        """threads  1 to 1024; by default the number of cores. Results do not depend on it.

        Raises an Error with the line of pent-sim if the scene cannot be simulated."""
        self._turn = _Turn()
        count = whole(threads, 1, 1024, "threads") if threads is not None else os.cpu_count() or 1
        meshes = [scene.mesh(body) for body in scene.bodies]
        for mesh in meshes:
            _require_dimension(mesh, scene.dimension)
        arrays = (_library.MeshArrays * len(meshes))(*[c_arrays(mesh) for mesh in meshes])
        opened = library().pent_open_scene(*scene._source, arrays, len(meshes), count)
        self._handle = Handle(opened, library().pent_close)
        self._number = opened
        self._kept: Handle | None = None
        self._dimension = scene.dimension

    def close(self) -> None:
        """Ends it. Views stay as they are; everything else raises an Error from now on."""
        with self._turn:
            self._kept = None
            self._handle.free()

    def __enter__(self) -> Simulation:
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        self.close()

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
        with self._turn:
            return int(library().pent_obstacle_count(self._number))

    def vertex_count(self, body: _BodyLike = 0) -> int:
        with self._turn:
            return int(library().pent_vertex_count(self._number, self._body(body)))

    def cell_count(self, body: _BodyLike = 0) -> int:
        with self._turn:
            return int(library().pent_cell_count(self._number, self._body(body)))

    def cells(self, body: _BodyLike = 0) -> Indices:
        """(cells, dimension + 1): a view."""
        with self._turn:
            number = self._body(body)
            count = library().pent_cell_count(self._number, number)
            address = library().pent_cells(self._number, number)
            return view(address, (count, self._dimension + 1), np.uint32, self._keep())

    def rest_positions(self, body: _BodyLike = 0) -> Floats:
        """(vertices, dimension), m, as placed: a view."""
        return self._vertices("pent_rest_positions", body)

    def positions(self, body: _BodyLike = 0) -> Floats:
        """(vertices, dimension), m: a view."""
        return self._vertices("pent_positions", body)

    def velocities(self, body: _BodyLike = 0) -> Floats:
        """(vertices, dimension), m/s: a view."""
        return self._vertices("pent_velocities", body)

    def forces(self, body: _BodyLike = 0) -> Floats:
        """(vertices, dimension), N, of all that has an energy: a view."""
        return self._vertices("pent_forces", body)

    def masses(self, body: _BodyLike = 0) -> Floats:
        """(vertices,), kg: a view."""
        with self._turn:
            number = self._body(body)
            count = library().pent_vertex_count(self._number, number)
            address = library().pent_masses(self._number, number)
            return view(address, (count,), np.float64, self._keep())

    def boundary(self, body: _BodyLike = 0) -> Indices:
        """The facets of its boundary, outward, (facets, dimension); found once, then a view."""
        with self._turn:
            count = ctypes.c_int64()
            number = self._body(body)
            address = library().pent_boundary(self._number, number, ctypes.byref(count))
            return view(address, (count.value, self._dimension), np.uint32, self._keep())

    def is_asleep(self, body: _BodyLike = 0) -> bool:
        with self._turn:
            return bool(library().pent_is_asleep(self._number, self._body(body)))

    def slice(
        self,
        body: _BodyLike = 0,
        normal: ArrayLike = (0.0, 0.0, 0.0, 1.0),
        offset: float = 0.0,
    ) -> Surface:
        """The slice of a body by the hyperplane normal . x = offset, m; in three dimensions its whole
        surface, whatever normal and offset. A copy."""
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

    # What you do. It counts from the next step on.

    def step(self, count: int = 1, *, progress: bool = False) -> StepReport:
        """Takes steps, and gives the report of the last. Ctrl-C stops between two.

        Raises an Error where a step cannot be solved: the state is then that before this step.
        """
        whole(count, 1, 2**62, "count")
        if count == 1 and not progress:
            return self._step()
        report = None
        for report in self.iterate(count, progress=progress):
            pass
        assert report is not None
        return report

    def iterate(self, count: int | None = None, *, progress: bool = False) -> Iterator[StepReport]:
        """Takes a step for each report that is asked for; without end if there is no `count`.

        progress  Shows how far it is, by tqdm if it is there.
        """
        if count is not None:
            whole(count, 0, 2**62, "count")
        return counted(self._steps(count), count, "step", progress)

    def _steps(self, count: int | None) -> Iterator[StepReport]:
        taken = 0
        while count is None or taken < count:
            yield self._step()
            taken += 1

    def _step(self) -> StepReport:
        report = _library.StepReport()
        with self._turn:
            library().pent_step(self._number, ctypes.byref(report))
        return StepReport(*[getattr(report, name) for name in StepReport._fields])

    def set_targets(self, body: _BodyLike, vertices: ArrayLike, targets: ArrayLike) -> None:
        """Takes vertices, (n,), to targets, (n, dimension), m, by the end of the next step, and holds
        them there."""
        with self._turn:
            number = self._body(body)
            some = self._some_vertices(number, vertices)
            places = floats(targets, (len(some), self._dimension), "targets")
            library().pent_set_targets(
                self._number, number, address_of(some), len(some), address_of(places)
            )

    def release(self, body: _BodyLike, vertices: ArrayLike) -> None:
        """Lets vertices, (n,), go."""
        with self._turn:
            number = self._body(body)
            some = self._some_vertices(number, vertices)
            library().pent_release(self._number, number, address_of(some), len(some))

    def add_grab(
        self,
        point: BodyPoint | Hit,
        anchor: ArrayLike,
        stiffness: float,
        *,
        damping: float = 0.0,
        max_force: float | None = None,
    ) -> Grab:
        """A spring from a point of a body to an anchor, (dimension,), m.

        stiffness  N/m, above 0.
        damping    N s/m.
        max_force  N: it never pulls harder; None for what the cells around the point bear.
        """
        made = _library.Grab()
        made.point = self._c_point(point.point if isinstance(point, Hit) else point)
        made.anchor[: self._dimension] = floats(anchor, (self._dimension,), "anchor").tolist()
        made.stiffness = real(stiffness, "stiffness")
        made.damping = real(damping, "damping")
        if max_force is not None:
            made.max_force = real(max_force, "max_force")
            if made.max_force == 0:
                raise ValueError("max_force: found 0; expected above 0, or None")
        with self._turn:
            return Grab(self, int(library().pent_add_grab(self._number, ctypes.byref(made))))

    def _move_grab(self, grab: int, anchor: ArrayLike) -> None:
        place = floats(anchor, (self._dimension,), "anchor")
        number = whole(grab, 0, 2**62, "grab")
        with self._turn:
            library().pent_move_grab(self._number, number, address_of(place))

    def _remove_grab(self, grab: int) -> None:
        number = whole(grab, 0, 2**62, "grab")
        with self._turn:
            library().pent_remove_grab(self._number, number)

    def set_forces(self, body: _BodyLike, forces: ArrayLike | None) -> None:
        """Forces on the vertices of a body, (vertices, dimension), N, in all steps until they are set
        anew; None for none."""
        with self._turn:
            number = self._body(body)
            given = None if forces is None else self._of_vertices(number, forces, "forces")
            library().pent_set_forces(self._number, number, address_of(given))

    def set_gravity(self, gravity: ArrayLike) -> None:
        """(dimension,), m/s^2."""
        given = floats(gravity, (self._dimension,), "gravity")
        with self._turn:
            library().pent_set_gravity(self._number, address_of(given))

    def set_state(self, body: _BodyLike, positions: ArrayLike, velocities: ArrayLike) -> None:
        """Puts a body somewhere: (vertices, dimension) each, m and m/s."""
        with self._turn:
            number = self._body(body)
            places = self._of_vertices(number, positions, "positions")
            speeds = self._of_vertices(number, velocities, "velocities")
            library().pent_set_state(self._number, number, address_of(places), address_of(speeds))

    def save(self) -> State:
        """The state as it is now."""
        with self._turn:
            return State(Handle(library().pent_save(self._number), library().pent_free_state))

    def restore(self, state: State) -> None:
        """Goes back to a state, of this simulation or one of the same bodies and obstacles, and from
        there on to the bit."""
        if not isinstance(state, State):
            raise TypeError(f"state: found {type(state).__name__}; expected what save() gives")
        with self._turn:
            library().pent_restore(self._number, state._handle.number)

    def add_body(self, name: str, mesh: Mesh, **keys: Any) -> None:
        """One more body, behind all others; keys are those of [[body]]."""
        if not isinstance(mesh, Mesh):
            raise TypeError(f"mesh: found {type(mesh).__name__}; expected a Mesh")
        _require_dimension(mesh, self._dimension)
        block = text(_toml.dumps({"body": [{"name": name, "mesh": "given", **keys}]}), "body")
        with self._reshaped():
            library().pent_add_body(self._number, block, ctypes.byref(c_arrays(mesh)))

    def remove_body(self, body: _BodyLike) -> None:
        """Takes a body away; later ones move up."""
        with self._reshaped():
            library().pent_remove_body(self._number, self._body(body))

    def add_obstacle(self, **keys: Any) -> None:
        """One more obstacle, behind all others; keys are those of [[obstacle]]."""
        block = text(_toml.dumps({"obstacle": [keys]}), "obstacle")
        with self._reshaped():
            library().pent_add_obstacle(self._number, block)

    def remove_obstacle(self, obstacle: int) -> None:
        """Takes an obstacle away; later ones move up."""
        number = whole(obstacle, -(2**31), 2**31 - 1, "obstacle")
        with self._reshaped():
            library().pent_remove_obstacle(self._number, number)

    def __repr__(self) -> str:
        if not self._handle.is_alive:
            return "<pentimento.Simulation: closed>"
        return f"<pentimento.Simulation: {self._dimension}D>"

    # Below, `_turn` is taken.

    def _reshaped(self) -> _Reshaped:
        return _Reshaped(self)

    def _keep(self) -> Handle:
        """Who owns the arrays of now."""
        if self._kept is None:
            self._kept = Handle(library().pent_keep(self._number), library().pent_free_kept)
        return self._kept

    def _body(self, body: _BodyLike) -> int:
        if isinstance(body, str):
            return int(library().pent_find_body(self._number, text(body, "body")))
        return whole(body, -(2**31), 2**31 - 1, "body")

    def _vertices(self, function: str, body: _BodyLike) -> Floats:
        with self._turn:
            number = self._body(body)
            count = library().pent_vertex_count(self._number, number)
            address = getattr(library(), function)(self._number, number)
            return view(address, (count, self._dimension), np.float64, self._keep())

    def _of_vertices(self, body: int, values: ArrayLike, name: str) -> Floats:
        count = library().pent_vertex_count(self._number, body)
        return floats(values, (count, self._dimension), name)

    def _some_vertices(self, body: int, vertices: ArrayLike) -> Indices:
        count = library().pent_vertex_count(self._number, body)
        return indices(vertices, ("n",), "vertices", count)

    def _c_point(self, point: BodyPoint) -> _library.Point:
        if not isinstance(point, tuple) or len(point) != 3:
            raise TypeError("point: expected a BodyPoint, or the Hit of pick()")
        made = _library.Point()
        made.body = whole(point[0], -(2**31), 2**31 - 1, "body")
        made.cell = whole(point[1], -(2**63), 2**63 - 1, "cell")
        count = self._dimension + 1
        made.weights[:count] = floats(point[2], (count,), "weights").tolist()
        return made


class _Reshaped:
    """A turn after which arrays are elsewhere."""

    __slots__ = ("_simulation",)

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def __enter__(self) -> None:
        self._simulation._turn.__enter__()

    def __exit__(self, *_: object) -> None:
        self._simulation._kept = None
        self._simulation._turn.__exit__()


def _require_dimension(mesh: Mesh, dimension: int) -> None:
    if mesh.dimension != dimension:
        raise Error(f"a mesh of {mesh.dimension} dimensions was given; the scene has {dimension}")
