"""Pictures and movies by pent-render, slices by pent-slice."""

from __future__ import annotations

import csv
import inspect
import os
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _programs
from .image import Image
from .mesh import Mesh
from .run import Run
from .surface import Surface

_Path = str | os.PathLike[str]
_Words = str | float | Sequence[float] | Sequence[str]
_Turns = str | Sequence[str] | Mapping[str, float]
_Frames = str | int | Sequence[int] | Sequence[str]

def render(
    what: Mesh | Run | _Path,
    *,
    sheet: bool = False,
    sheet_frames: int | None = None,
    frames: _Frames | None = None,
    w: _Words | None = None,
    rotate: _Turns | None = None,
    normal: Sequence[float] | None = None,
    offset: _Words | None = None,
    project: str | None = None,
    eye: float | None = None,
    color: str | None = None,
    size: Sequence[int] | None = None,
    azimuth: float | None = None,
    elevation: float | None = None,
    fov: float | None = None,
    onion: bool = False,
    sweep: bool = False,
    range: tuple[float, float] | None = None,
    no_floor: bool = False,
    no_obstacles: bool = False,
    no_caption: bool = False,
    threads: int | None = None,
) -> Image:
    """A picture of the slice of a mesh or a run, by pent-render; its options are the keywords, and
    docs/viewer.md says what each means.

    sheet  Several frames on one sheet; otherwise one picture, of the last frame where `frames` does
           not say.
    size   Pixels, (width, height).

    Raises a ProgramError with the line of pent-render.
    """
    look = {name: value for name, value in locals().items() if name not in ("what", "sheet")}
    if not sheet and frames is None:
        look["frames"] = "last"
    with tempfile.TemporaryDirectory(prefix="pentimento-") as folder:
        picture = Path(folder, "picture.png")
        _render(what, "--sheet" if sheet else "--output", picture, look)
        return Image(picture.read_bytes())


def movie(
    what: Mesh | Run | _Path, output: _Path, *, fps: float | None = None, **look: Any
) -> Path:
    """A movie of a run, or of a mesh with `sweep`, by pent-render; other keywords are those of
    render(), but `sheet`.

    output  Ends in .mp4, which needs ffmpeg; or the name of a folder, for a picture of each frame.
    fps     Pictures a second; by default as in the simulation.

    Gives where it is: the output or, without ffmpeg, the folder of the pictures in its place.
    """
    unknown = look.keys() - (inspect.signature(render).parameters.keys() - {"what", "sheet"})
    if unknown:
        raise TypeError(f"{min(unknown)}: is no keyword of movie()")
    return _render(what, "--output", Path(output), {**look, "fps": fps})


def _render(what: Any, kind: str, output: Path, look: dict[str, Any]) -> Path:
    size = look.get("size")
    if size is not None and not isinstance(size, str):
        look = {**look, "size": "x".join(str(side) for side in size)}
    with _programs.as_input(what) as path:
        words = [*_programs.options(**look), kind, str(output)]
        (file,) = _programs.run("pent-render", path, words)["files"]
    return Path(file)


@dataclass(frozen=True, eq=False)
class Slice:
    """What pent-slice made of one body at one frame."""

    body: str  #: Its name; "obstacle.1" and so on for obstacles, BODY.outline for its outline.
    frame: int
    index: int  #: Of the hyperplane, in the order given; 0 where there is one.
    surface: Surface


def slice(
    what: Mesh | Run | _Path,
    *,
    frames: _Frames | None = None,
    w: _Words | None = None,
    rotate: _Turns | None = None,
    normal: Sequence[float] | None = None,
    offset: _Words | None = None,
    project: str | None = None,
    eye: float | None = None,
    color: str | None = None,
    keep_degenerate: bool = False,
    obstacles: bool = False,
    threads: int | None = None,
) -> list[Slice]:
    """Slices of a mesh or a run as surfaces, by pent-slice; its options are the keywords, and
    docs/viewer.md says what each means. Vertices have the colors, and the quantity of `color`, as
    attributes.

    Raises a ProgramError with the line of pent-slice.
    """
    words = _programs.options(
        frames=frames, w=w, rotate=rotate, normal=normal, offset=offset, project=project, eye=eye,
        color=color, keep_degenerate=keep_degenerate, obstacles=obstacles, threads=threads,
    )  # fmt: skip
    with _programs.as_input(what) as path, tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "slices")
        _programs.run("pent-slice", path, [*words, "--output", str(out)])
        return sorted(_slices_in(out), key=lambda one: (one.body, one.index, one.frame))


def _slices_in(folder: Path) -> Iterator[Slice]:
    """Those of slices.csv, hyperplanes in their order, and outlines, which it does not list."""
    indices: Counter[tuple[str, int]] = Counter()
    table = folder / "slices.csv"
    with open(table, encoding="utf-8", errors="surrogateescape", newline="") as rows:
        for row in csv.DictReader(rows):
            body, frame = row["body"], int(row["frame"])
            yield Slice(body, frame, indices[body, frame], _read_ply(folder / row["file"]))
            indices[body, frame] += 1
    for body, frame in indices:
        outline = folder / f"{body}.outline_{frame:06d}.ply"
        if outline.exists():
            yield Slice(f"{body}.outline", frame, 0, _read_ply(outline))


def _read_ply(path: Path) -> Surface:
    """A surface as pent-slice writes it (docs/viewer.md)."""
    header, body = path.read_bytes().split(b"end_header\n", 1)
    types = {"double": "<f8", "float": "<f4", "uchar": "u1"}
    counts: dict[str, int] = {}
    fields: list[tuple[str, str]] = []
    for words in (line.split() for line in header.decode().splitlines()):
        if words[:1] == ["element"]:
            counts[words[1]] = int(words[2])
        elif words[:1] == ["property"] and words[1] != "list":
            fields.append((words[2], types[words[1]]))
    vertices = np.frombuffer(body, np.dtype(fields), counts["vertex"])
    triangle = np.dtype([("count", "u1"), ("corners", "<u4", 3)])
    faces = np.frombuffer(body, triangle, counts["face"], vertices.nbytes)
    attributes: dict[str, NDArray[Any]] = {
        name: vertices[name].copy() for name, _ in fields if name not in "xyz"
    }
    points = np.column_stack([vertices[axis] for axis in "xyz"])
    return Surface(points, faces["corners"].copy(), attributes=attributes)
