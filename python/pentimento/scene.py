"""Scenes: what there is, of what it is made, and what is done to it."""

from __future__ import annotations

import hashlib
import os
import tempfile
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _programs, _toml
from ._arrays import text as c_text
from ._library import library
from .errors import Error
from .mesh import Mesh, path_bytes

if TYPE_CHECKING:
    from .run import Run
    from .simulation import Simulation

_Path = str | os.PathLike[str]
_WRITTEN = "*-" + 16 * "[0-9a-f]" + ".pent"  # what _write_beside() calls its files


class Scene:
    """A scene that has been checked, with every default filled in. It never changes.

    docs/simulator.md has every key, with its unit and range.
    """

    def __init__(
        self,
        tables: Mapping[str, Any],
        *,
        folder: _Path = "",
        meshes: Mapping[str, Mesh] | None = None,
    ) -> None:
        """A scene from a dict, as a scene file is written: tables by their names, lists of tables
        for `body`, `constraint`, `obstacle` and so on.

        The `mesh` of a body is a Mesh or a path; `meshes` has those of bodies by name instead.
        folder  What paths are relative to.

        Raises an Error with the line of pent-sim, its line number that of the TOML text.
        """
        given = dict(meshes or {})
        plain = {name: _without_meshes(value, given) for name, value in tables.items()}
        self._check(_toml.dumps(plain), "scene", folder, given)

    @classmethod
    def read(cls, path: _Path) -> Scene:
        """A scene from a file. Raises an Error with the line of pent-sim."""
        name = path_bytes(path)
        try:
            content = Path(path).read_bytes()
        except OSError as error:
            raise Error(f"{os.fsdecode(name)}: {error.strerror}") from None
        made = cls.__new__(cls)
        text = content.decode("utf-8", "surrogateescape")
        made._check(text, os.fsdecode(name), Path(path).parent, {})
        return made

    @classmethod
    def from_text(
        cls, text: str, *, folder: _Path = "", meshes: Mapping[str, Mesh] | None = None
    ) -> Scene:
        """A scene from the text of a scene file. Raises an Error with the line of pent-sim, "scene"
        in place of the file."""
        made = cls.__new__(cls)
        made._check(text, "scene", folder, dict(meshes or {}))
        return made

    def _check(self, text: str, name: str, folder: _Path, meshes: dict[str, Mesh]) -> None:
        # Kept as it is given: messages of a simulation tell lines of it, too.
        self._source = (c_text(text, "text"), c_text(name, "name"), path_bytes(folder))
        full = library().pent_scene_text(*self._source)
        self._text: str = full.decode("utf-8", "surrogateescape")
        self._tables: dict[str, Any] = tomllib.loads(self._text)
        self._given = frozenset(meshes)
        self._meshes = meshes
        for body, mesh in meshes.items():
            if body not in self.bodies:
                raise Error(f'a mesh was given for the body "{body}", which is not in the scene')
            if not isinstance(mesh, Mesh):
                raise TypeError(f"the mesh of {body}: found {type(mesh).__name__}; expected a Mesh")

    @property
    def text(self) -> str:
        """As the text of a scene file, with every default; it reads again as the same scene."""
        return self._text

    @property
    def tables(self) -> dict[str, Any]:
        """As a dict; a copy."""
        return tomllib.loads(self._text)

    @property
    def bodies(self) -> tuple[str, ...]:
        """Their names, in order."""
        return tuple(body["name"] for body in self._tables["body"])

    @property
    def dimension(self) -> int:
        """3 or 4."""
        return int(self._tables["scene"]["dimension"])

    @property
    def frames(self) -> int:
        """How many frames pent-sim writes behind the start."""
        return int(self._tables["scene"]["frames"])

    @property
    def steps_per_frame(self) -> int:
        """How many time steps go from one frame to the next."""
        return int(self._tables["scene"]["steps_per_frame"])

    def mesh(self, body: str) -> Mesh:
        """The mesh of a body, as loaded; read once. Raises an Error if it cannot be read."""
        if body not in self._meshes:
            paths = {table["name"]: table["mesh"] for table in self._tables["body"]}
            if body not in paths:
                raise Error(f'no body is called "{body}"; there are {", ".join(paths)}')
            self._meshes[body] = Mesh.read(paths[body])
        return self._meshes[body]

    def simulate(self, *, threads: int | None = None) -> Simulation:
        """A simulation of this scene; see Simulation."""
        from .simulation import Simulation

        return Simulation(self, threads=threads)

    def run(
        self,
        folder: _Path,
        *,
        threads: int | None = None,
        force: bool = False,
        resume: bool = False,
        isa: str | None = None,
        progress: bool = False,
    ) -> Run:
        """Runs the whole scene by pent-sim into a folder, with all that a run has: frames, report,
        resume. A mesh that is no file becomes one in FOLDER.meshes, for who runs it again; those
        of earlier runs that it has no use for go once it is made.

        progress  Shows the frames as they come, by tqdm if it is there.

        Raises a ProgramError with the line of pent-sim for what is refused; how a run that began
        ended is `Run.report["verdict"]`. After Ctrl-C `resume` goes on.
        """
        from ._progress import FrameCounter
        from .run import Run

        words = _programs.options(
            output=folder, threads=threads, force=force, resume=resume, isa=isa
        )
        with tempfile.TemporaryDirectory(prefix="pentimento-") as place:
            path = Path(place, "scene.toml")
            files = Path(os.path.abspath(folder) + ".meshes")
            tables = self._tables_of_files(files, place)
            path.write_text(_toml.dumps(tables), "utf-8", "surrogateescape")
            with FrameCounter(Path(folder), self.frames + 1, progress) as counter:
                _programs.run("pent-sim", path, words, allowed=(0, 3), tick=counter.look)
        used = {body["mesh"] for body in tables["body"]}
        for file in files.glob(_WRITTEN):
            if str(file) not in used:
                file.unlink()
        return Run(folder)

    def _tables_of_files(self, folder: Path, place: str) -> dict[str, Any]:
        """The tables with a file for each mesh, for a scene file in `place`."""
        tables = self.tables
        moved = library().pent_scene_text_for(*self._source, path_bytes(place))
        of_place = tomllib.loads(moved.decode("utf-8", "surrogateescape"))
        for body, there in zip(tables["body"], of_place["body"], strict=True):
            name = body["name"]
            if "recipe" in there:
                body["recipe"] = there["recipe"]
            if name in self._given:
                body["mesh"] = str(_write_beside(folder, name, self._meshes[name]))
            else:
                body["mesh"] = os.path.abspath(body["mesh"])
        return tables

    def __repr__(self) -> str:
        return f"<pentimento.Scene: {self.dimension}D, {', '.join(self.bodies)}>"


def _write_beside(folder: Path, name: str, mesh: Mesh) -> Path:
    """Writes a mesh under a name that tells its content, too: a run that pent-sim then refuses has
    not replaced the mesh of the run that is there."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as place:
        new = Path(place, "mesh.pent")
        mesh.write(new)
        content = hashlib.sha256(new.read_bytes()).hexdigest()[:16]
        return new.replace(folder / f"{name}-{content}.pent")


def _without_meshes(value: Any, meshes: dict[str, Mesh]) -> Any:
    """A table, or a list of them, with "given" where there is a Mesh, which goes into `meshes`."""
    if isinstance(value, (list, tuple)):
        return [_without_meshes(part, meshes) for part in value]
    if isinstance(value, Mapping) and isinstance(value.get("mesh"), Mesh):
        meshes[str(value.get("name"))] = value["mesh"]
        return {**value, "mesh": "given"}
    return value


class SceneBuilder:
    """A scene built in Python, a call for each block of a scene file; keys are keywords.

    A key that is a word of Python gets an underscore behind it: `from_=2.0`.

        scene = (
            SceneBuilder(gravity=[0, -9.8, 0, 0], frames=60)
            .body("ball", ball, material={"young": 1e5})
            .obstacle(half_space={"normal": [0, 1, 0, 0], "offset": -1})
            .build()
        )
    """

    def __init__(self, /, **scene: Any) -> None:
        """scene  The keys of [scene]."""
        self._tables: dict[str, Any] = {"scene": _keys(scene)}

    def table(self, name: str, /, **keys: Any) -> SceneBuilder:
        """A block that there is once, as "contact", "solver", "damping", "sleep"."""
        self._tables.setdefault(name, {}).update(_keys(keys))
        return self

    def block(self, kind: str, /, **keys: Any) -> SceneBuilder:
        """One more block of a kind, as "constraint", "attachment", "activation"."""
        self._tables.setdefault(kind, []).append(_keys(keys))
        return self

    def body(self, name: str, mesh: Mesh | _Path, **keys: Any) -> SceneBuilder:
        """One more body; its mesh is a Mesh or a path."""
        return self.block("body", name=name, mesh=mesh, **keys)

    def obstacle(self, /, **keys: Any) -> SceneBuilder:
        """Adds an `[[obstacle]]`: what stands, or moves as told, and does not bend."""
        return self.block("obstacle", **keys)

    def constraint(self, /, **keys: Any) -> SceneBuilder:
        """Adds a `[[constraint]]`: vertices of a body that stay or move as told."""
        return self.block("constraint", **keys)

    def contact(self, /, **keys: Any) -> SceneBuilder:
        """Sets keys of `[contact]`: how bodies touch one another."""
        return self.table("contact", **keys)

    def solver(self, /, **keys: Any) -> SceneBuilder:
        """Sets keys of `[solver]`: elements, integrator, tolerances."""
        return self.table("solver", **keys)

    def damping(self, /, **keys: Any) -> SceneBuilder:
        """Sets keys of `[damping]`, `mass` in 1/s and `stiffness` in s."""
        return self.table("damping", **keys)

    def build(self, *, folder: _Path = "") -> Scene:
        """The scene, checked; see Scene."""
        return Scene(self._tables, folder=folder)


def _keys(keys: Mapping[str, Any]) -> dict[str, Any]:
    return {name.rstrip("_"): value for name, value in keys.items()}
