"""Run folders of pent-sim."""

from __future__ import annotations

import ctypes
import json
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import Floats, view, whole
from ._library import Field, FrameInfo, Handle, library
from ._rotations import Rotations
from .errors import Error
from .mesh import Mesh, html_table, path_bytes, seen_field
from .scene import Scene
from .surface import Surface

_FRAME = re.compile(r"(.+)_(\d{6,})\.pent")


@dataclass(frozen=True, eq=False)
class Frame:
    """A body at one moment. Its arrays are read-only views of the library's, without a copy; they
    stay valid as long as anybody has one."""

    number: int  #: From 0, the start.
    step: int  #: Time steps taken so far.
    time: float  #: s.
    positions: Floats  #: (vertices, dimension), m.
    velocities: Floats | None  #: (vertices, dimension), m/s.
    contact_forces: Floats | None  #: (vertices, dimension), N.
    fields: dict[str, Floats]
    """Further quantities by their names: (vertices,), or (vertices, dimension) for vectors."""
    mesh_crc32c: int  #: The checksum of the mesh that it belongs to.

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Frame:
        """A frame from a `.pent` file. Raises an Error that says what is wrong with the file."""
        number = library().pent_read_frame(path_bytes(path))
        handle = Handle(number, library().pent_free_frame)
        info = FrameInfo()
        library().pent_frame_info_of(number, ctypes.byref(info))
        shape = (info.vertices, info.dimension)

        def seen(address: int | None) -> Floats | None:
            return None if address is None else view(address, shape, np.float64, handle)

        return cls(
            number=info.frame,
            step=info.step,
            time=info.time,
            positions=view(info.positions, shape, np.float64, handle),
            velocities=seen(info.velocities),
            contact_forces=seen(info.contact_forces),
            fields=dict(_fields(handle, info)),
            mesh_crc32c=info.mesh_crc32c,
        )


def _fields(handle: Handle, info: FrameInfo) -> Iterator[tuple[str, Floats]]:
    for number in range(info.field_count):
        field = Field()
        library().pent_frame_field(handle.number, number, ctypes.byref(field))
        yield seen_field(field, info.vertices, handle)


class Run:
    """A run folder. Nothing is read before it is asked for; a run that goes on grows in sight."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Raises an Error if the folder is none of a run."""
        path_bytes(path)
        self.path = Path(path)
        self._meshes: dict[str, Mesh] = {}
        self._whole: set[int] = set()  # numbers of frames that every body had when asked
        names = sorted(file.stem for file in self.path.glob("meshes/*.pent"))
        if not names:
            raise Error(f"{self.path}: expected the folder of a run, with meshes/BODY.pent in it")
        self.bodies: tuple[str, ...] = tuple(names)  #: Their names, in ascending order.

    @property
    def frames(self) -> tuple[int, ...]:
        """Numbers of the frames that every body has, ascending; looked up each time."""
        found: dict[str, set[int]] = {body: set() for body in self.bodies}
        for file in self.path.glob("frames/*.pent"):
            match = _FRAME.fullmatch(file.name)
            if match is not None and match[1] in found:
                found[match[1]].add(int(match[2]))
        return tuple(sorted(set.intersection(*found.values())))

    @property
    def report(self) -> dict[str, Any]:
        """report.json: verdict, size, warnings, and what is known of every part, frame and step
        (docs/simulator.md). Raises an Error if it is not there."""
        path = self.path / "report.json"
        try:
            found: dict[str, Any] = json.loads(path.read_bytes())
        except (OSError, ValueError) as error:
            raise Error(f"{path}: {error}") from None
        return found

    @property
    def scene(self) -> Scene:
        """The scene as run, with every default."""
        return Scene.read(self.path / "scene.toml")

    def mesh(self, body: int | str = 0) -> Mesh:
        """The mesh of a body as placed; read once."""
        name = self._name(body)
        if name not in self._meshes:
            self._meshes[name] = Mesh.read(self.path / "meshes" / f"{name}.pent")
        return self._meshes[name]

    def frame(self, number: int, body: int | str = 0) -> Frame:
        """A frame of a body; -1 is the last, and so on.

        Raises an IndexError if it is not there, an Error if it is damaged or of another mesh."""
        name = self._name(body)
        whole(number, -(2**62), 2**62, "frame")
        if number < 0 or not self._is_there(number) or not self._file(number, name).exists():
            frames = self.frames
            if number < 0 and -number <= len(frames):
                number = frames[number]
            if number not in frames:
                known = f"{frames[0]} to {frames[-1]}" if frames else "none yet"
                raise IndexError(f"{self.path}: has no frame {number}; there are {known}")
        return self._read(number, name)

    def _is_there(self, number: int) -> bool:
        # Asks for its files alone, and once: who reads all frames would list all of them for each,
        # and who reads all bodies would ask for those of all of them for each.
        if number not in self._whole:
            if not all(self._file(number, name).exists() for name in self.bodies):
                return False
            self._whole.add(number)
        return True

    def _file(self, number: int, name: str) -> Path:
        return self.path / "frames" / f"{name}_{number:06d}.pent"

    def _read(self, number: int, name: str) -> Frame:
        path = self._file(number, name)
        frame = Frame.read(path)
        if frame.mesh_crc32c != self.mesh(name).crc32c:
            raise Error(f"{path}: is a frame of another mesh than {self.path}/meshes/{name}.pent")
        return frame

    def __len__(self) -> int:
        return len(self.frames)

    def iterate(self, body: int | str = 0) -> Iterator[Frame]:
        """The frames of a body that are there now, one after the other."""
        for number in self.frames:
            yield self.frame(number, body)

    def array(
        self, quantity: str = "positions", body: int | str = 0, frames: Sequence[int] | None = None
    ) -> NDArray[np.float64]:
        """A quantity of a body at many frames as one array, (frames, vertices, ...); a copy.

        quantity  "positions", "velocities", "contact_forces", or a name out of Frame.fields.
        frames    Their numbers; by default all.
        """
        numbers = self.frames if frames is None else frames
        found = [_quantity(self.frame(number, body), quantity) for number in numbers]
        if not found:
            raise Error(f"{self.path}: there is no frame to take {quantity} of")
        return np.stack(found)

    def times(self) -> Floats:
        """(frames,), s."""
        return np.array([self.frame(number).time for number in self.frames])

    def slice(
        self,
        frame: int,
        body: int | str = 0,
        normal: ArrayLike | None = None,
        offset: float = 0.0,
        *,
        rotate: Rotations | None = None,
        shading: bool = False,
    ) -> Surface:
        """The slice of a body at a frame, as Mesh.slice()."""
        points = self.frame(frame, body).positions
        return self.mesh(body).slice(normal, offset, points, rotate=rotate, shading=shading)

    def __repr__(self) -> str:
        return f"<pentimento.Run: {self.path}, {', '.join(self.bodies)}, {len(self)} frames>"

    def _name(self, body: int | str) -> str:
        if isinstance(body, str):
            if body not in self.bodies:
                raise Error(f'no body is called "{body}"; there are {", ".join(self.bodies)}')
            return body
        return self.bodies[whole(body, 0, len(self.bodies) - 1, "body")]

    def _repr_png_(self) -> bytes | None:
        from . import _look

        return _look.picture_of(self)

    def _repr_html_(self) -> str:
        from . import _look

        frames = self.frames
        rows = {"folder": str(self.path), "bodies": ", ".join(self.bodies)}
        rows["frames"] = f"{frames[0]} to {frames[-1]}" if frames else "none yet"
        try:
            rows["verdict"] = str(self.report.get("verdict", "running"))
        except Error:
            rows["verdict"] = "unknown: there is no report.json"
        sheet = _look.picture_of(self, sheet=True) if len(frames) > 1 else self._repr_png_()
        return html_table("Run", rows) + _look.html_picture(sheet)


def _quantity(frame: Frame, name: str) -> Floats:
    known = {
        "positions": frame.positions,
        "velocities": frame.velocities,
        "contact_forces": frame.contact_forces,
        **frame.fields,
    }
    values = known.get(name)
    if values is None:
        there = ", ".join(key for key, value in known.items() if value is not None)
        raise Error(f"frame {frame.number}: has no {name}; there are {there}")
    return values
