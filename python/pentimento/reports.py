"""What a simulation gives and takes: reports, energies, points, grabs and states."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from numpy.typing import ArrayLike

from ._arrays import Floats
from ._library import Handle

if TYPE_CHECKING:
    from .simulation import Simulation


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
    """All that goes from one step of a simulation to the next, kept in the memory of this process:
    it cannot be pickled. What is to go on later is a run, by Scene.run()."""

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
