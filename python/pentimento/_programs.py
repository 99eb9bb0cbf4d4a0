"""The programs beside the library, run as programs: what is said and found goes through files."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .errors import ProgramError

Arguments = list[str]


def find(program: str) -> str:
    """The path of a program: in the folder that PENTIMENTO_BIN names, in this package, or where
    the shell finds it. Raises a ProgramError that says where it was looked for."""
    folder = os.environ.get("PENTIMENTO_BIN") or str(Path(__file__).parent / "bin")
    found = shutil.which(program, path=folder) or shutil.which(program)
    if found is None:
        raise ProgramError(
            f"{program} is neither in {folder} nor where the shell looks; let PENTIMENTO_BIN name"
            " the folder of the programs",
            program,
            None,
        )
    return found


def options(**values: Any) -> Arguments:
    """Options of a program by their names: `edge_length=0.1` is --edge-length 0.1.

    None and False are left out, True is a flag, lists are words with commas between.
    """
    words: Arguments = []
    for name, value in values.items():
        if value is None or value is False:
            continue
        words.append("--" + name.rstrip("_").replace("_", "-"))
        if value is not True:
            words.append(_word(name, value))
    return words


def _word(name: str, value: Any) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, os.PathLike):
        return str(os.fspath(value))
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, (list, tuple, range)):
        return ",".join(_word(name, part) for part in value)
    if isinstance(value, Mapping):  # of rotations
        return ",".join(f"{plane}:{_word(name, degrees)}" for plane, degrees in value.items())
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return repr(value)
    raise TypeError(f"{name}: found {type(value).__name__}; expected a number, text or a list")


def run(
    program: str,
    file: str | os.PathLike[str] | None,
    arguments: Sequence[str],
    *,
    allowed: tuple[int, ...] = (0,),
    tick: Callable[[], None] | None = None,
) -> dict[str, Any]:
    """Runs a program over a file to its end, and gives its report.

    tick  Called a few times a second meanwhile.

    Raises a ProgramError with the program's line for an exit code that is not `allowed`. Ctrl-C
    asks the program to stop, waits for it, and goes on up.
    """
    path = find(program)
    with tempfile.TemporaryDirectory(prefix="pentimento-") as folder:
        report = Path(folder, "report.json")
        words = [path, *_positional(file), *arguments, "--quiet", "--json", str(report)]
        try:
            process = subprocess.Popen(
                words,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                process_group=0,  # Ctrl-C reaches it through us: a second signal would kill it
            )
        except (OSError, ValueError) as error:
            raise ProgramError(f"{program} cannot be run: {error}", program, None) from None
        said = _wait(process, tick)
        if process.returncode not in allowed:
            raise ProgramError(_last_line(program, said), program, process.returncode)
        found: dict[str, Any] = json.loads(report.read_bytes()) if report.exists() else {}
        return found


def _positional(file: str | os.PathLike[str] | None) -> Arguments:
    if file is None:
        return []
    name = os.fspath(file)
    return ["./" + name if name.startswith("-") else name]  # no option


def _wait(process: subprocess.Popen[bytes], tick: Callable[[], None] | None) -> bytes:
    try:
        while True:
            try:
                out, error = process.communicate(timeout=0.2)
                return error or out
            except subprocess.TimeoutExpired:
                if tick is not None:
                    tick()
    except BaseException:
        process.terminate()
        try:
            process.communicate()
        except BaseException:
            process.kill()
            process.communicate()
        raise


def _last_line(program: str, said: bytes) -> str:
    lines = [line for line in said.decode("utf-8", "replace").splitlines() if line.strip()]
    return lines[-1].removeprefix(program + ": ") if lines else f"{program} failed without a word"


@contextmanager
def as_input(what: Any) -> Iterator[str]:
    """A path to what a program shall look at: a mesh goes through a file."""
    from .mesh import Mesh
    from .run import Run

    if isinstance(what, Mesh):
        with tempfile.TemporaryDirectory(prefix="pentimento-") as folder:
            path = Path(folder, "mesh.pent")
            what.write(path)
            yield str(path)
    elif isinstance(what, Run):
        yield str(what.path)
    elif isinstance(what, (str, os.PathLike)):
        yield os.fspath(what)
    else:
        raise TypeError(f"found {type(what).__name__}; expected a Mesh, a Run or a path")
