"""What the tests share. They use the package where it is written, and what CMake built."""

from __future__ import annotations

import itertools
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

import numpy as np  # noqa: E402
import pytest  # noqa: E402

import pentimento  # noqa: E402


def box(dimension: int, count: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Points and cells of a unit box, cut along the paths from corner to corner [kuhn1960]."""
    grid = np.array(list(itertools.product(range(count + 1), repeat=dimension)))
    strides = (count + 1) ** np.arange(dimension)[::-1]
    cells = []
    for corner in itertools.product(range(count), repeat=dimension):
        for order in itertools.permutations(range(dimension)):
            moves = np.eye(dimension)[list(order)]
            steps = np.vstack([corner, np.array(corner) + np.cumsum(moves, axis=0)])
            path = [int(step @ strides) for step in steps]
            if np.linalg.det(moves) < 0:
                path[0], path[1] = path[1], path[0]
            cells.append(path)
    return grid / count, np.array(cells)


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
