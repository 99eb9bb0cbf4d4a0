"""What comes in is checked here, what goes out is seen here: numbers, indices, texts and views."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.uint32]


def _array(value: Any, kinds: str, name: str, wanted: str) -> NDArray[Any]:
    try:
        array = np.asarray(value)
    except ValueError:
        raise ValueError(f"{name}: rows of different lengths; expected {wanted}") from None
    if array.dtype.kind not in kinds and array.size > 0:
        raise TypeError(f"{name}: found {array.dtype}; expected {wanted}")
    # What is under a mask is whatever was there.
    if isinstance(value, np.ma.MaskedArray) and np.any(value.mask):
        raise ValueError(f"{name}: found masked values; expected {wanted}, all of them there")
    return array


def _shape_text(shape: tuple[int | str, ...]) -> str:
    return "(" + ", ".join(str(side) for side in shape) + ("," if len(shape) == 1 else "") + ")"


def floats(value: ArrayLike, shape: tuple[int | str, ...], name: str) -> Floats:
    """`value` as contiguous doubles; sides of `shape` that are words may be of any length.

    Raises a TypeError for what is not real numbers, a ValueError for another shape or values that
    are masked.
    """
    array = _array(value, "iuf", name, "real numbers")
    fits = len(array.shape) == len(shape) and all(
        isinstance(side, str) or side == found for side, found in zip(shape, array.shape)
    )
    if not fits:
        found = _shape_text(array.shape)
        raise ValueError(f"{name}: found the shape {found}; expected {_shape_text(shape)}")
    return np.ascontiguousarray(array, dtype=np.float64)


def indices(
    value: ArrayLike,
    shape: tuple[int | str, ...],
    name: str,
    below: int = 2**32,
    dtype: type[np.unsignedinteger[Any]] = np.uint32,
) -> NDArray[Any]:
    """`value` as contiguous whole numbers from 0 up to, not including, `below`.

    Raises a TypeError for what is not whole numbers, a ValueError for another shape or values that
    are masked, an IndexError for a number out of range.
    """
    array = _array(value, "iu", name, "whole numbers")
    if len(array.shape) != len(shape) or any(
        not isinstance(side, str) and side != found for side, found in zip(shape, array.shape)
    ):
        found = _shape_text(array.shape)
        raise ValueError(f"{name}: found the shape {found}; expected {_shape_text(shape)}")
    if array.size > 0:
        low, high = int(array.min()), int(array.max())
        if low < 0 or high >= below:
            wrong = low if low < 0 else high
            raise IndexError(f"{name}: found {wrong}; expected 0 to {below - 1}")
    return np.ascontiguousarray(array, dtype=dtype)


def shown(value: Any) -> str:
    """A value in a message: short, and in one line."""
    line = " ".join(repr(value).split())
    return line if len(line) <= 60 else line[:57] + "..."


def whole(value: Any, low: int, high: int, name: str) -> int:
    """A whole number from `low` to `high`; a TypeError or an IndexError otherwise."""
    try:
        if isinstance(value, (bool, np.bool_)):
            raise TypeError
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: found {shown(value)}; expected a whole number") from None
    if not low <= number <= high:
        raise IndexError(f"{name}: found {number}; expected {low} to {high}")
    return number


def real(value: Any, name: str) -> float:
    """A real number; a TypeError otherwise."""
    if isinstance(value, (bool, str, bytes, np.bool_)):
        raise TypeError(f"{name}: found {shown(value)}; expected a number")
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name}: found {shown(value)}; expected a number") from None


def text(value: Any, name: str) -> bytes:
    """Text as C has it; a TypeError, or a ValueError for text that C cannot have."""
    if not isinstance(value, str):
        raise TypeError(f"{name}: found {type(value).__name__}; expected text")
    if "\0" in value:
        raise ValueError(f"{name}: has a zero character in it")
    return value.encode("utf-8", "surrogateescape")


class _Block:
    """Memory of the library as numpy asks for it, with who owns it."""

    __slots__ = ("__array_interface__", "owner")

    def __init__(self, interface: dict[str, Any], owner: object) -> None:
        self.__array_interface__ = interface
        self.owner = owner


def view(address: int, shape: tuple[int, ...], dtype: type[Any], owner: object) -> NDArray[Any]:
    """Memory of the library as a read-only array that keeps its owner alive; no copy."""
    interface = {
        "data": (address, True),
        "shape": shape,
        "typestr": np.dtype(dtype).str,
        "version": 3,
    }
    return np.asarray(_Block(interface, owner))


def copy(address: int | None, shape: tuple[int, ...], dtype: type[Any]) -> NDArray[Any]:
    """Memory of the library, which will change, copied."""
    if 0 in shape or address is None:
        return np.zeros(shape, dtype)
    return view(address, shape, dtype, None).copy()


def address_of(array: NDArray[Any] | None) -> int | None:
    """Where a contiguous array is; None for none."""
    return None if array is None else array.ctypes.data
