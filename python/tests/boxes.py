"""Boxes, cut into simplices."""

from __future__ import annotations

import itertools

import numpy as np


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
