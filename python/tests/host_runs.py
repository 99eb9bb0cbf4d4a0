"""What the tests of the add-on for Blender and of the reader for ParaView look at."""

from __future__ import annotations

import math
import os
import pathlib

from boxes import box

import pentimento

#: The unit tesseract, turned by xw:45: x + w = 1 cuts it in a box of sqrt(2) x 1 x 1.
TILTED = {"rotate": {"xw": 45}, "offset": math.sqrt(0.5)}
TILTED_VOLUME = math.sqrt(2)
TILTED_AREA = 2 + 4 * math.sqrt(2)


def use_built() -> None:
    """Where nothing else is said: what the preset dev built."""
    built = pathlib.Path(__file__).resolve().parents[2] / "build" / "dev"
    os.environ.setdefault("PENTIMENTO_BUILD", str(built))
    os.environ.setdefault("PENTIMENTO_LIBRARY", str(built / "plugin" / "libpent_plugin.so"))
    os.environ.setdefault("PENTIMENTO_BIN", str(built / "bin"))


def falling(dimension: int, mesh: pentimento.Mesh, frames: int = 8) -> pentimento.Scene:
    """Two bodies that fall, and meet each other and the ground."""
    zeros = [0.0] * (dimension - 2)
    return (
        pentimento.SceneBuilder(dimension=dimension, gravity=[0, -9, *zeros])
        .table("scene", frames=frames, steps_per_frame=2)
        .table("output", vertex=["contact_force"])
        .body("high", mesh, place={"translate": [0.2, 1.12, *zeros]}, velocity=[0.0, -4.0, *zeros])
        .body("low", mesh)
        .obstacle(half_space={"normal": [0, 1, *zeros]}, distance=0.1)
        .contact(distance=0.1)
        .build()
    )


def make(folder: pathlib.Path) -> None:
    """In `folder`: run/ of four dimensions, solid/ of three, tesseract.pent and flat.pent."""
    tesseract = pentimento.Mesh(*box(4, 2))
    falling(4, tesseract).run(folder / "run")
    falling(3, pentimento.Mesh(*box(3, 2))).run(folder / "solid")
    pentimento.Mesh(*box(4)).write(folder / "tesseract.pent")
    pentimento.Mesh(*box(2)).write(folder / "flat.pent")
