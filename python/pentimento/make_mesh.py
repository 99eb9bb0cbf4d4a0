"""Bodies made by pent-mesh, and files of other programs by pent-convert."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _programs
from ._arrays import floats, indices
from .mesh import Mesh

_Path = str | os.PathLike[str]


def make_mesh(
    input: _Path | tuple[ArrayLike, ArrayLike] | None = None,
    *,
    sphere: int | None = None,
    ball: int | None = None,
    box: Sequence[int] | None = None,
    size: float | Sequence[float] | None = None,
    cut: str | None = None,
    format: str | None = None,
    unit: str | None = None,
    scale: float | None = None,
    translate: Sequence[float] | None = None,
    level: float | None = None,
    labels: bool = False,
    spacing: Sequence[float] | None = None,
    output: _Path | None = None,
    dim: int | None = None,
    ascii: bool = False,
    histogram: _Path | None = None,
    time_limit: float | None = None,
    step_limit: float | None = None,
    memory_limit: float | None = None,
    yes: bool = False,
    repair: str | None = None,
    wrap_distance: float | None = None,
    surface_triangles: int | None = None,
    edge_length: float | None = None,
    size_field: str | None = None,
    size_growth: float | None = None,
    longest_edge: float | None = None,
    target_pentachora: int | None = None,
    generator: str | None = None,
    radius_edge_ratio: float | None = None,
    subdivide_surface: bool = False,
    subdivide: int | None = None,
    quadratic: bool = False,
    curved: bool = False,
    thickness: float | None = None,
    extrude: Sequence[float] | None = None,
    layers: int | None = None,
    grade: float | None = None,
    layer_heights: Sequence[float] | None = None,
    round: bool = False,
    profile: _Path | None = None,
    one_sided: bool = False,
    order: str | None = None,
    edge_directions: _Path | None = None,
    unextruded: bool = False,
    lean: bool = False,
    space_time: bool = False,
    time_scale: float | None = None,
    refine_time: int | str | None = None,
    every: int | None = None,
    time_step: float | None = None,
    body: str | None = None,
    region_array: str | None = None,
    bisection: bool = False,
    threads: int | None = None,
    **more: Any,
) -> Mesh:
    """Makes a body: fills a closed surface, extrudes it along w, and proves the result.

    pent-mesh does it, a program of its own with its own licence (GPL); each of its options is a
    keyword here, with the unit and range that `pent-mesh --help` and docs/mesher.md tell. Those of
    a later pent-mesh are taken as they come (`more`).

    input   A file with a surface, tetrahedra, a four-dimensional shape or its boundary, an image of
            four axes, or (with `space_time`) a moving mesh; or arrays: (points, triangles) of a
            closed surface, (points, tetrahedra) of a solid, points (n, 3) in m.
            None with `sphere`, `ball` or `box`.
    output  Where the `.pent` file goes, if it is to stay.

    The mesh has what pent-mesh reported in `report`: its proof, its quality, its repairs. Raises a
    ProgramError with the line of pent-mesh.
    """
    others = ("input", "output", "more")
    given = {name: value for name, value in locals().items() if name not in (*others, "others")}
    unknown = {"quiet", "json", "quality", "slabs", "help", "version"} & more.keys()
    if unknown:
        raise TypeError(
            f"{unknown.pop()}: is no keyword of make_mesh(), which gives one mesh with all that is"
            " told of it in mesh.report; pent-mesh itself takes it"
        )
    words = _programs.options(**given, **more)
    with tempfile.TemporaryDirectory(prefix="pentimento-") as folder, _file_of(input) as file:
        path = Path(folder, "mesh.pent") if output is None else Path(output)
        words += ["--output", str(path)]
        report = _programs.run("pent-mesh", file, words)
        mesh = Mesh.read(path)
    mesh.report = report
    return mesh


def convert(
    input: _Path | Mesh,
    output: _Path,
    *,
    frames: Sequence[_Path] = (),
    double: bool = False,
    mfem_attributes: bool = False,
) -> dict[str, Any]:
    """From and to the files of other programs of four dimensions: 4OFF, G4MF, 4DO, OBJ, MFEM and
    `.pent`, by their endings; Gmsh and legacy VTK as views. Gives what pent-convert reports; raises
    a ProgramError with its line.

    frames  Of a run of the mesh, as in run/frames: each becomes a blend shape of a G4MF file.
    """
    words = _programs.options(output=output, double=double, mfem_attributes=mfem_attributes)
    if frames:
        words += ["--frames", *[os.fspath(frame) for frame in frames]]
    with _programs.as_input(input) as path:
        return _programs.run("pent-convert", path, words)


@contextmanager
def _file_of(input: Any) -> Iterator[str | None]:
    if input is None or isinstance(input, (str, os.PathLike)):
        yield None if input is None else os.fspath(input)
        return
    if not isinstance(input, (tuple, list)) or len(input) != 2:
        raise TypeError("input: expected a path, or (points, triangles) or (points, tetrahedra)")
    points = floats(input[0], ("points", 3), "points")
    cells = indices(input[1], ("cells", "corners"), "cells", max(len(points), 1))
    kinds = {3: "Triangles", 4: "Tetrahedra"}
    if cells.shape[1] not in kinds:
        raise ValueError(f"cells: found {cells.shape[1]} corners; expected 3 or 4")
    from_one = (cells.astype(np.int64) + 1).tolist()
    with tempfile.TemporaryDirectory(prefix="pentimento-") as folder:
        if cells.shape[1] == 3:
            path = Path(folder, "surface.obj")
            lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
            lines += ["f {} {} {}".format(*corners) for corners in from_one]
        else:
            path = Path(folder, "solid.mesh")
            lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points))]
            lines += [f"{x!r} {y!r} {z!r} 0" for x, y, z in points.tolist()]
            lines += ["Tetrahedra", str(len(cells))]
            lines += ["{} {} {} {} 0".format(*corners) for corners in from_one]
            lines += ["End"]
        path.write_text("\n".join(lines) + "\n")
        yield str(path)
