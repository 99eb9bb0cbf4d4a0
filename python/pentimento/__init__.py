"""Pentimento: deformable bodies of four spatial dimensions.

    Mesh, make_mesh, convert       bodies, made and read
    Scene, SceneBuilder            what there is, and what is done to it
    Simulation                     a scene in motion, step by step
    Run, Frame                     what pent-sim wrote
    render, movie, slice           pictures, movies, surfaces
    View                           slices of a run as they are looked at
    study, Study, Unit, Frontier   speed against accuracy

docs/python.md begins at the beginning.
"""

from ._version import __version__
from .errors import Error, ProgramError
from .image import Image
from .make_mesh import convert, make_mesh
from .mesh import Mesh
from .render import Slice, movie, render, slice
from .reports import BodyPoint, Energy, Grab, Hit, State, StepReport
from .run import Frame, Run
from .scene import Scene, SceneBuilder
from .simulation import Simulation
from .study import Frontier, Study, Unit, study
from .surface import Surface
from .view import View

__all__ = [
    "BodyPoint",
    "Energy",
    "Error",
    "Frame",
    "Frontier",
    "Grab",
    "Hit",
    "Image",
    "Mesh",
    "ProgramError",
    "Run",
    "Scene",
    "SceneBuilder",
    "Simulation",
    "Slice",
    "State",
    "StepReport",
    "Study",
    "Surface",
    "Unit",
    "View",
    "__version__",
    "convert",
    "make_mesh",
    "movie",
    "render",
    "slice",
    "study",
]
