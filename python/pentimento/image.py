"""Pictures as pent-render makes them: PNG, as bytes or as an array."""

from __future__ import annotations

import os
import struct
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import Error


class Image:
    """A picture, which shows itself in a notebook."""

    def __init__(self, png: bytes) -> None:
        """png  A PNG file of 8 bits a channel, not interlaced."""
        self.png = bytes(png)

    @property
    def array(self) -> NDArray[np.uint8]:
        """(height, width, 3), or 4 or 1 channels, sRGB, 0 to 255. Raises an Error for a file that
        is not understood."""
        return _decoded(self.png)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the PNG file."""
        with open(path, "wb") as file:
            file.write(self.png)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return self.array if dtype is None else self.array.astype(dtype)

    def __repr__(self) -> str:
        wide, high = struct.unpack(">II", self.png[16:24]) if len(self.png) >= 24 else (0, 0)
        return f"<pentimento.Image: {wide} x {high}>"

    def _repr_png_(self) -> bytes:
        return self.png


def _chunks(png: bytes) -> dict[bytes, bytes]:
    found: dict[bytes, bytes] = {}
    at = 8
    while at + 8 <= len(png):
        (size,) = struct.unpack(">I", png[at : at + 4])
        kind = png[at + 4 : at + 8]
        found[kind] = found.get(kind, b"") + png[at + 8 : at + 8 + size]
        at += size + 12
    return found


def _decoded(png: bytes) -> NDArray[np.uint8]:
    chunks = _chunks(png) if png[:8] == b"\x89PNG\r\n\x1a\n" else {}
    try:
        wide, high, depth, color, _, _, interlaced = struct.unpack(">IIBBBBB", chunks[b"IHDR"])
        channels = {0: 1, 2: 3, 6: 4}[color]
        if depth != 8 or interlaced:
            raise ValueError
        raw = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8)
        lines = raw.reshape(high, 1 + wide * channels)
    except (KeyError, ValueError, struct.error, zlib.error):
        raise Error("the picture is no PNG file of 8 bits a channel, or it is damaged") from None
    pixels = np.zeros((high, wide, channels), np.uint8)
    above = np.zeros((wide, channels), np.uint8)
    for row, line in enumerate(lines):
        above = _unfiltered(int(line[0]), line[1:].reshape(wide, channels), above)
        pixels[row] = above
    return pixels


def _unfiltered(kind: int, line: NDArray[np.uint8], above: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """One row of pixels from what stands in the file, by the filters of the PNG specification."""
    if kind == 0:
        return line
    if kind == 1:
        return np.add.accumulate(line, axis=0, dtype=np.uint8)
    if kind == 2:
        return line + above
    if kind not in (3, 4):
        raise Error(f"the picture has a row of filter {kind}; expected 0 to 4")
    made = np.empty_like(line)
    for channel in range(line.shape[1]):
        made[:, channel] = _by_neighbors(
            kind == 4, line[:, channel].tolist(), above[:, channel].tolist()
        )
    return made


def _by_neighbors(is_paeth: bool, line: list[int], above: list[int]) -> list[int]:
    made: list[int] = []
    left = corner = 0
    for value, up in zip(line, above):
        if is_paeth:
            a, b, c = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
            guess = left if a <= b and a <= c else up if b <= c else corner
        else:
            guess = (left + up) >> 1
        left = (value + guess) & 255
        corner = up
        made.append(left)
    return made
