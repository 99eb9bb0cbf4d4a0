"""What the tests share. They use the package where it is written, and what CMake built."""

from __future__ import annotations

import os
import pathlib
import sys

PYTHON = pathlib.Path(__file__).resolve().parents[1]
ROOT = PYTHON.parent
if not os.environ.get("PENTIMENTO_INSTALLED"):  # by hand, in an environment that has the wheel
    sys.path.insert(0, str(PYTHON))
    built = ROOT / "build" / "dev"
    os.environ.setdefault("PENTIMENTO_LIBRARY", str(built / "plugin" / "libpent_plugin.so"))
    os.environ.setdefault("PENTIMENTO_BIN", str(built / "bin"))

import pytest  # noqa: E402
from boxes import box  # noqa: E402

import pentimento  # noqa: E402


@pytest.fixture(scope="session")
def tesseract() -> pentimento.Mesh:
    return pentimento.Mesh(*box(4))


@pytest.fixture(scope="session")
def cube() -> pentimento.Mesh:
    return pentimento.Mesh(*box(3))


def two_boxes(mesh: pentimento.Mesh, **solver) -> pentimento.Scene:
    """One box on the ground, one above."""
    zeros = [0.0] * (mesh.dimension - 2)
    up = [0.0, 1.0, *zeros]
    return (
        pentimento.SceneBuilder(dimension=mesh.dimension, gravity=[0, -9, *zeros])
        .table("scene", frames=6, steps_per_frame=2)
        .body("low", mesh)
        .body("high", mesh, place={"translate": [0.2, 1.3, *zeros]}, velocity=[0.0, -2.0, *zeros])
        .obstacle(half_space={"normal": up}, distance=0.1)
        .contact(distance=0.1)
        .solver(**solver)
        .build()
    )


@pytest.fixture
def scene(tesseract: pentimento.Mesh) -> pentimento.Scene:
    return two_boxes(tesseract)


@pytest.fixture
def simulation(scene: pentimento.Scene):
    with scene.simulate(threads=1) as opened:
        yield opened
