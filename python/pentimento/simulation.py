"""A scene in motion."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from types import TracebackType
from typing import Any

from numpy.typing import ArrayLike

from . import _library, _toml
from ._arrays import Floats, Indices, address_of, floats, indices, real, text, whole
from ._library import Handle, library
from ._progress import counted
from ._sight import BodyLike, Sight, require_dimension
from .mesh import Mesh, c_arrays
from .reports import BodyPoint, Grab, Hit, State, StepReport


class Simulation(Sight):
    """A scene in motion, which you step. A context manager: it is closed at the end of `with`.

    A body is named by its number, from 0, or its name. Lengths are in m, velocities in m/s, forces
    in N, energies in J, times in s.

    Arrays of vertices and cells are read-only views of the library's own: they show the state as it
    is when you look, through all steps; `.copy()` keeps what they show now. When bodies come or go,
    or the simulation is closed, a view stays valid and shows what was there last. While another
    thread steps a view may show some vertices before and some after the step.

    Steps run without the interpreter's lock. A simulation is for one thread at a time, another is
    refused with an Error; different simulations may be used at once. Ctrl-C stops between two
    steps. What is refused has changed nothing.
    """

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

    def __reduce__(self) -> Any:
        raise TypeError(
            "a simulation cannot be pickled or copied: it is in the memory of this process alone;"
            " its scene can be, and simulates anew"
        )

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

    def set_targets(self, body: BodyLike, vertices: ArrayLike, targets: ArrayLike) -> None:
        """Takes vertices, (n,), to targets, (n, dimension), m, by the end of the next step, and
        holds them there."""
        with self._turn:
            number = self._body(body)
            some = self._some_vertices(number, vertices)
            places = floats(targets, (len(some), self._dimension), "targets")
            library().pent_set_targets(
                self._number, number, address_of(some), len(some), address_of(places)
            )

    def release(self, body: BodyLike, vertices: ArrayLike) -> None:
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

    def set_forces(self, body: BodyLike, forces: ArrayLike | None) -> None:
        """Forces on the vertices of a body, (vertices, dimension), N, in all steps until they are
        set anew; None for none."""
        with self._turn:
            number = self._body(body)
            given = None if forces is None else self._of_vertices(number, forces, "forces")
            library().pent_set_forces(self._number, number, address_of(given))

    def set_gravity(self, gravity: ArrayLike) -> None:
        """(dimension,), m/s^2."""
        given = floats(gravity, (self._dimension,), "gravity")
        with self._turn:
            library().pent_set_gravity(self._number, address_of(given))

    def set_state(self, body: BodyLike, positions: ArrayLike, velocities: ArrayLike) -> None:
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
        """Goes back to a state, of this simulation or one of the same bodies, obstacles and time
        step, and from there on, with the same scene to the bit. To go on with another time step
        set_state() takes positions and velocities."""
        if not isinstance(state, State):
            raise TypeError(f"state: found {type(state).__name__}; expected what save() gives")
        with self._turn:
            library().pent_restore(self._number, state._handle.number)

    def add_body(self, name: str, mesh: Mesh, **keys: Any) -> None:
        """One more body, behind all others; keys are those of [[body]]."""
        if not isinstance(mesh, Mesh):
            raise TypeError(f"mesh: found {type(mesh).__name__}; expected a Mesh")
        require_dimension(mesh, self._dimension)
        block = text(_toml.dumps({"body": [{"name": name, "mesh": "given", **keys}]}), "body")
        with self._reshaped():
            library().pent_add_body(self._number, block, ctypes.byref(c_arrays(mesh)))

    def remove_body(self, body: BodyLike) -> None:
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
