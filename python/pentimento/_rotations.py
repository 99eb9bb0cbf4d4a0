"""Rotations as pent-slice takes them: turns in planes, in degrees, one after the other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ._arrays import Floats, real, shown
from ._library import Hyperplane, Turn

Rotations = str | Sequence[str] | Mapping[str, float]  #: "xw:30", ["xw:30", "yz:10"], {"xw": 30}

_AXES = "xyzw"


def turns(rotate: Rotations | None) -> list[tuple[int, int, float]]:
    """From which axis towards which, and how far in degrees, each turn goes.

    Raises a ValueError or TypeError for what is none.
    """
    found = []
    for plane, degrees in _pairs(rotate):
        is_plane = len(plane) == 2 and plane[0] != plane[1] and set(plane) <= set(_AXES)
        if not is_plane:
            raise ValueError(f"rotate: found the plane {shown(plane)}; expected two of x y z w")
        found.append((_AXES.index(plane[0]), _AXES.index(plane[1]), degrees))
    return found


def _pairs(rotate: Rotations | None) -> Iterator[tuple[str, float]]:
    if rotate is None:
        return
    if isinstance(rotate, Mapping):
        for plane, degrees in rotate.items():
            yield plane, real(degrees, f"rotate: {plane}")
        return
    words = rotate.split(",") if isinstance(rotate, str) else rotate
    for word in words:
        try:
            plane, angle = word.split(":")
            degrees = float(angle)
        except (AttributeError, ValueError):
            raise ValueError(
                f"rotate: found {shown(word)}; expected a plane and degrees, as in xw:30"
            ) from None
        yield plane, degrees


def hyperplane(rotate: Rotations | None, offset: float) -> Hyperplane:
    """As the C interface has it."""
    found = [Turn(*turn) for turn in turns(rotate)]
    return Hyperplane((Turn * len(found))(*found), len(found), offset)


def normal_of(rotate: Rotations | None) -> Floats:
    """(4,): the direction that the rotations turn to w."""
    total = np.eye(4)
    for start, end, degrees in turns(rotate):
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        first, second = total[start].copy(), total[end].copy()
        total[start], total[end] = c * first - s * second, s * first + c * second
    row: Floats = total[3]
    return row
