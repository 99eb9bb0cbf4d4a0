"""How far something is, by tqdm if it is there."""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, TypeVar

T = TypeVar("T")


def _bar(total: int | None, unit: str, shown: bool) -> Any:
    if not shown:
        return None
    try:
        return importlib.import_module("tqdm.auto").tqdm(total=total, unit=unit)
    except ImportError:
        return None


def counted(things: Iterable[T], total: int | None, unit: str, shown: bool) -> Iterator[T]:
    """The things, counted as they come."""
    bar = _bar(total, unit, shown)
    try:
        for thing in things:
            yield thing
            if bar is not None:
                bar.update()
    finally:
        if bar is not None:
            bar.close()


class FrameCounter:
    """Counts the frames of a run that is being written."""

    def __init__(self, folder: Path, total: int, shown: bool) -> None:
        self._folder = folder
        self._bar = _bar(total, "frame", shown)

    def look(self) -> None:
        if self._bar is not None:
            numbers = {path.stem[-6:] for path in self._folder.glob("frames/*.pent")}
            self._bar.update(max(len(numbers) - self._bar.n, 0))

    def __enter__(self) -> FrameCounter:
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        self.look()
        if self._bar is not None:
            self._bar.close()
