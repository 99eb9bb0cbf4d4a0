"""What a run has in Blender: its hyperplane, its frame and its colors, on an empty object."""

import dataclasses

import bpy
import numpy as np
from bpy.props import (
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from .views import View

SHADINGS = (
    ("SMOOTH", "Smooth", "By the body's own boundary in all its dimensions, as pent-render does"),
    ("FLAT", "Flat", "Every triangle as it is"),
)
QUANTITIES = (
    ("body", "Body", "A color for each body"),
    ("w", "w", "The fourth coordinate, m"),
    ("speed", "Speed", "m/s"),
    ("strain", "Strain", "The norm of the Green strain, averaged over the cells at a vertex"),
    ("force", "Contact force", "N; in frames of scenes that ask for it"),
    ("reaction", "Reaction", "N; in frames of scenes that ask for it"),
    ("energy_density", "Energy density", "J/m^n; in frames of scenes that ask for it"),
)


@dataclasses.dataclass(frozen=True)
class Look:
    """What a slice depends on, but for the body; its text tells slices apart."""

    path: str
    frame: int  # of the run
    offset: float
    angles: tuple  # of View.PLANES, degrees
    shading: str
    color: str
    low: float
    high: float

    @property
    def rotate(self):
        return {plane: angle for plane, angle in zip(View.PLANES, self.angles) if angle != 0}


def decimal(value):
    """A number as it was typed: Blender keeps properties in single precision."""
    return float(str(np.float32(value)))


def look_of(settings, view):
    """The look that these settings mean, animated or not."""
    return Look(
        path=settings.path,
        # Interpolated frames may be a rounding of single precision below the whole number.
        frame=view.frame_at(settings.frame * (1 + 2**-22) + 1e-3),
        offset=decimal(settings.offset),
        angles=tuple(decimal(getattr(settings, plane)) for plane in View.PLANES),
        shading=settings.shading,
        color=settings.color,
        low=decimal(settings.low),
        high=decimal(settings.high),
    )


def _changed(settings, _context):
    from .slicing import refresh

    refresh(settings.id_data)


def _angle(plane):
    start, end = plane
    return FloatProperty(
        name=f"{plane} (\N{DEGREE SIGN})",
        description=f"Turns the bodies about the origin, {start} towards {end}, in degrees. The"
        f" turns come in the order {' '.join(View.PLANES)}",
        soft_min=-180,
        soft_max=180,
        step=100,
        precision=2,
        update=_changed,
    )


class PentimentoRun(bpy.types.PropertyGroup):
    """Of the empty object that stands for a run; no path: of any other object."""

    path: StringProperty(
        name="Run", description="The run folder, or a .pent mesh", subtype="FILE_PATH",
        update=_changed,
    )  # fmt: skip
    dimension: IntProperty(default=4)
    frame: FloatProperty(
        name="Frame", description="Of the run, from 0; between two frames the first is shown",
        precision=1, step=100, update=_changed,
    )  # fmt: skip
    offset: FloatProperty(
        name="Offset w", description="The slice is w = offset of the turned bodies, in m",
        precision=4, step=1, update=_changed,
    )  # fmt: skip
    shading: EnumProperty(name="Normals", items=SHADINGS, update=_changed)
    color: EnumProperty(
        name="Color", description="What the attribute Color shows", items=QUANTITIES,
        update=_changed,
    )  # fmt: skip
    low: FloatProperty(
        name="From", description="The value of the first color", precision=4, update=_changed
    )
    high: FloatProperty(
        name="To", description="The value of the last color", default=1, precision=4,
        update=_changed,
    )  # fmt: skip
    last: IntProperty(description="The last frame of the run that the keys of the import go to")
    message: StringProperty(description="Why the slice is not that of the settings; empty if it is")


PentimentoRun.__annotations__.update({plane: _angle(plane) for plane in View.PLANES})


class PentimentoBody(bpy.types.PropertyGroup):
    """Of a mesh object that is sliced."""

    run: PointerProperty(type=bpy.types.Object, name="Run", description="Whose slice it is")
    body: StringProperty(name="Body", description="Its name; empty for all in one")


def run_of(thing):
    """The run that an object is, or is of; None for others."""
    if thing is None:
        return None
    if thing.pentimento.path:
        return thing
    return thing.pentimento_body.run


def register():
    bpy.utils.register_class(PentimentoRun)
    bpy.utils.register_class(PentimentoBody)
    bpy.types.Object.pentimento = PointerProperty(type=PentimentoRun)
    bpy.types.Object.pentimento_body = PointerProperty(type=PentimentoBody)


def unregister():
    del bpy.types.Object.pentimento_body
    del bpy.types.Object.pentimento
    bpy.utils.unregister_class(PentimentoBody)
    bpy.utils.unregister_class(PentimentoRun)
