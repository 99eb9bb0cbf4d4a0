"""What programs that show slices look at."""

from __future__ import annotations

import bisect
import dataclasses
import math
import os
from pathlib import Path

import numpy as np

from ._arrays import Floats
from ._rotations import Rotations, normal_of
from .errors import Error
from .mesh import Mesh
from .run import Frame, Run
from .surface import Surface

_PLANES = ("zw", "yw", "yz", "xw", "xz", "xy")


class View:
    """A run folder, or one mesh as a run of one frame, as it is looked at: slices, a frame at a
    time, with what is known of their vertices. Of each body two frames are kept: the first, and the
    last that was looked at.
    """

    PLANES = _PLANES  #: In the order in which programs with six angles turn, as pent-view does.

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """path  The run folder, a file of it as scene.toml, or a mesh, which ends in .pent.

        Raises an Error that says what is wrong with what there is."""
        self.path = Path(path)  #: The run folder or the mesh.
        if self.path.is_file() and self.path.suffix != ".pent":
            self.path = self.path.parent
        self._run: Run | None = None
        if self.path.is_file():
            self._meshes = {self.path.stem: Mesh.read(self.path)}
        else:
            self._run = Run(self.path)
            self._meshes = {name: self._run.mesh(name) for name in self._run.bodies}
        self.bodies: tuple[str, ...] = tuple(self._meshes)  #: Their names, in ascending order.
        dimensions = {mesh.dimension for mesh in self._meshes.values()}
        if len(dimensions) > 1:
            raise Error(f"{self.path}: has bodies of different dimensions; expected one")
        self.dimension: int = dimensions.pop()  #: 3 or 4; three-dimensional bodies are seen whole.
        if self.dimension == 2:
            raise Error(f"{self.path}: a mesh of 2 dimensions; slices are of bodies of 3 or 4")
        self._fields: dict[str, dict[str, Floats]] = {}  # of meshes, once looked at
        self._first: dict[str, Frame] = {}
        self._last: dict[str, tuple[int, Frame, dict[str, Floats]]] = {}
        self._rate: float | None = None
        self.frames: tuple[int, ...] = ()
        """Numbers of the frames that every body has, ascending, as of the last refresh()."""
        self.refresh()

    def refresh(self) -> None:
        """Looks again which frames there are: a run that goes on grows. Raises an Error if there
        is none."""
        self._first.clear()
        self._last.clear()
        self._rate = None
        self.frames = (0,) if self._run is None else self._run.frames
        if not self.frames:
            raise Error(f"{self.path}: has no frame of every body yet; expected frames/")

    @property
    def frames_per_second(self) -> float:
        """Of the simulation; 0 where there is one frame."""
        if self._rate is None:
            first, last = self.frames[0], self.frames[-1]
            seconds = self.time(last) - self.time(first)
            self._rate = (last - first) / seconds if seconds > 0 else 0.0
        return self._rate

    def frame_at(self, number: float) -> int:
        """The last frame that is there up to `number`, or the first: where one is missing, the one
        before it stays."""
        return self.frames[max(bisect.bisect_right(self.frames, number) - 1, 0)]

    def extent(self, rotate: Rotations | None = None) -> tuple[float, float]:
        """The lowest and the highest w of the bodies at the first frame, turned, m. Zeros in three
        dimensions."""
        if self.dimension == 3:
            return (0.0, 0.0)
        normal = normal_of(rotate)
        heights = [self._start(body).positions @ normal for body in self.bodies]
        lowest = min(float(of_body.min()) for of_body in heights)
        return (lowest, max(float(of_body.max()) for of_body in heights))

    def middle(self, rotate: Rotations | None = None) -> float:
        """The offset of the slice that pent-slice takes by itself: through the middle of the bodies
        at the first frame, to about a hundredth of their extent, m. 0 in three dimensions."""
        low, high = self.extent(rotate)
        middle = (low + high) / 2
        if not high > low:
            return middle
        digit = 10.0 ** (math.floor(math.log10(high - low)) - 2)
        part, whole = math.modf(middle / digit)
        # Halves away from zero, as pent-slice rounds them; round() takes them to the even side.
        return (whole + math.copysign(abs(part) >= 0.5, part)) * digit

    def slice(
        self,
        body: str,
        number: int,
        rotate: Rotations | None = None,
        offset: float = 0.0,
        *,
        shading: bool = False,
    ) -> Surface:
        """The slice of a body at one of its frames, as Mesh.slice(), with attributes:

        body  Its number, from 0.
        w, speed, strain, force  As `pent-slice --color` has them; force where frames have contact
            forces, and what else frames have, as reaction and energy_density, and meshes have of
            their vertices, vectors by their length; of one name the first of these.

        Raises an Error if the frame is not there, or damaged.
        """
        frame, quantities = self._frame(number, body)
        mesh = self._meshes[body]
        surface = mesh.slice(None, offset, frame.positions, rotate=rotate, shading=shading)
        attributes = {name: surface.interpolate(values) for name, values in quantities.items()}
        index = np.full(len(surface.points), float(self.bodies.index(body)))
        others = {name: values for name, values in attributes.items() if name != "body"}
        return dataclasses.replace(surface, attributes={"body": index, **others})

    def time(self, number: int) -> float:
        """s, of a frame."""
        first = number == self.frames[0]
        body = self.bodies[0]
        return (self._start(body) if first else self._read(number, body)).time

    def _start(self, body: str) -> Frame:
        if body not in self._first:
            self._first[body] = self._read(self.frames[0], body)
        return self._first[body]

    def _read(self, number: int, body: str) -> Frame:
        if body not in self._meshes:
            known = ", ".join(self.bodies)
            raise Error(f'{self.path}: no body is called "{body}"; there are {known}')
        if self.frame_at(number) != number:
            known = f"{self.frames[0]} to {self.frames[-1]}"
            raise Error(f"{self.path}: has no frame {number}; there are {known}")
        if self._run is None:
            return _at_rest(self._meshes[body])
        return self._run._read(number, body)

    def _frame(self, number: int, body: str) -> tuple[Frame, dict[str, Floats]]:
        held = self._last.get(body)
        if held is None or held[0] != number:
            frame = self._read(number, body)
            held = (number, frame, self._quantities(body, frame))
            self._last[body] = held
        return held[1:]

    def __repr__(self) -> str:
        bodies = ", ".join(self.bodies)
        return (
            f"<pentimento.View: {self.path}, {self.dimension}D, {bodies},"
            f" {len(self.frames)} frame{'s' * (len(self.frames) != 1)}>"
        )

    def _quantities(self, body: str, frame: Frame) -> dict[str, Floats]:
        """At the vertices of the mesh."""
        mesh = self._meshes[body]
        if body not in self._fields:
            self._fields[body] = {k: _lengths(v) for k, v in mesh.quantities().items()}
        zeros = np.zeros(mesh.vertex_count)
        found = {
            "w": frame.positions[:, 3] if mesh.dimension == 4 else zeros,
            "speed": zeros if frame.velocities is None else _lengths(frame.velocities),
            "strain": mesh.strain(frame.positions),
        }
        if frame.contact_forces is not None:
            found["force"] = _lengths(frame.contact_forces)
        for name, values in frame.fields.items():
            found.setdefault(name, _lengths(values))
        return {**self._fields[body], **found}


def _at_rest(mesh: Mesh) -> Frame:
    return Frame(0, 0, 0.0, mesh.points, None, None, {}, mesh.crc32c)


def _lengths(values: Floats) -> Floats:
    if values.ndim == 1:
        return values
    lengths: Floats = np.linalg.norm(values, axis=1)
    return lengths
