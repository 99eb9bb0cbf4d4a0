"""Speed against accuracy: studies of pent-study."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import _programs, _toml
from .errors import Error


class Frontier:
    """What a study found: error against time of every combination of settings, and which of them no
    other beats in both (docs/study.md)."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        """folder  That of a study that is finished. Raises an Error if it is none."""
        self.folder = Path(folder)
        path = self.folder / "study.json"
        try:
            self.report: dict[str, Any] = json.loads(path.read_bytes())
            self.results: list[dict[str, Any]] = self.report["results"]
            self.frontier: list[dict[str, Any]] = [
                self.results[number] for number in self.report["frontier"]
            ]
        except (OSError, ValueError, KeyError, IndexError, TypeError) as error:
            raise Error(f"{path}: expected the folder of a finished study ({error})") from None

    @property
    def sentences(self) -> list[str]:
        """What to choose, one for each level of error."""
        return [str(sentence) for sentence in self.report.get("sentences", [])]

    def __repr__(self) -> str:
        return f"<pentimento.Frontier: {self.folder}, {len(self.frontier)} of {len(self.results)}>"

    def _repr_png_(self) -> bytes | None:
        path = self.folder / "frontier.png"
        return path.read_bytes() if path.exists() else None

    def _repr_html_(self) -> str:
        from . import _look

        lines = "".join(f"<li>{html.escape(line)}</li>" for line in self.sentences)
        return f"<ul>{lines}</ul>" + _look.html_picture(self._repr_png_())


def study(
    scene: str | os.PathLike[str],
    folder: str | os.PathLike[str],
    vary: Mapping[str, Any],
    *,
    repeat: int | None = None,
    frames: int | None = None,
    reference_halvings: int | None = None,
    reference_integrator: str | None = None,
    keep_runs: bool = False,
    force: bool = False,
    error: float | None = None,
    budget: float | None = None,
    write_scene: str | os.PathLike[str] | None = None,
    threads: int | None = None,
) -> Frontier:
    """Runs a scene file over settings and compares, by pent-study; its options are the keywords.

    vary  Values by what is varied, as in {"dt": ["1/30", "1/60"], "integrator": "bdf2"}: numbers,
          True and False, texts, lists and dicts, as in a Scene. A text alone is one of them, or
          several with commas; a number or a dict alone is the one.

    A study that was interrupted goes on where it stopped. Raises a ProgramError with the line of
    pent-study.
    """
    words = _programs.options(
        output=folder, repeat=repeat, frames=frames, reference_halvings=reference_halvings,
        reference_integrator=reference_integrator, keep_runs=keep_runs, force=force, error=error,
        budget=budget, write_scene=write_scene, threads=threads,
    )  # fmt: skip
    _programs.run("pent-study", scene, words + _axes(vary))
    return Frontier(folder)


def _axes(vary: Mapping[str, Any]) -> list[str]:
    words = []
    for name, values in vary.items():
        is_one = isinstance(values, (str, Mapping)) or not isinstance(values, Iterable)
        text = ",".join(_value(name, value) for value in ([values] if is_one else values))
        words += ["--vary", f"{name}={text}"]
    return words


def _value(name: str, value: Any) -> str:
    return value if isinstance(value, str) else _toml.value_text(name, value)


@dataclass(frozen=True)
class Unit:
    """A part of a study that is run by itself."""

    number: int  #: From 1.
    kind: str  #: "reference" (a level of it) or "combination" (of settings).
    name: str  #: Of its files in the folder.
    is_done: bool  #: Nothing of it is missing in a collection.


class Study:
    """A study in parts, whose units run anywhere that sees its folder, in any order, many at a time
    (docs/distributed.md). Every call raises a ProgramError with the line of pent-study."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        """folder  That of a study that has been prepared."""
        self.folder = Path(folder)
        _ = self.units  # says what is wrong with the folder

    @classmethod
    def prepare(
        cls,
        scene: str | os.PathLike[str],
        folder: str | os.PathLike[str],
        vary: Mapping[str, Any],
        *,
        repeat: int | None = None,
        frames: int | None = None,
        reference_halvings: int | None = None,
        reference_integrator: str | None = None,
        keep_runs: bool = False,
        force: bool = False,
        threads: int | None = None,
    ) -> Study:
        """Makes the meshes and numbers the units; runs nothing. Keywords are those of study()."""
        words = _programs.options(
            prepare=True, output=folder, repeat=repeat, frames=frames,
            reference_halvings=reference_halvings, reference_integrator=reference_integrator,
            keep_runs=keep_runs, force=force, threads=threads,
        )  # fmt: skip
        _programs.run("pent-study", scene, words + _axes(vary))
        return cls(folder)

    @property
    def units(self) -> list[Unit]:
        """All units, as they are now; the levels of the reference first."""
        report = self._run(list_runs=True)
        return [Unit(**unit) for unit in report["units"]]

    def run(self, number: int) -> str:
        """Runs a unit unless it is done: "finished", "diverged" or "refused"."""
        return str(self._run(run=number)["outcome"])

    def collect(
        self,
        *,
        error: float | None = None,
        budget: float | None = None,
        write_scene: str | os.PathLike[str] | None = None,
    ) -> Frontier:
        """Compares the runs of all units. What is missing is named in the error."""
        self._run(collect=True, error=error, budget=budget, write_scene=write_scene)
        return Frontier(self.folder)

    def _run(self, **values: Any) -> dict[str, Any]:
        words = _programs.options(output=self.folder, **values)
        return _programs.run("pent-study", None, words)

    def __repr__(self) -> str:
        units = self.units
        done = sum(unit.is_done for unit in units)
        return f"<pentimento.Study: {self.folder}, {done} of {len(units)} units>"
