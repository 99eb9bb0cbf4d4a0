"""What a user does: import a run, look at it again, fit its colors, slice through its middle."""

import math
import os

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from . import slicing
from .settings import look_of, run_of
from .views import FAILURES, forget, one_line, view_of


class PENTIMENTO_OT_import(bpy.types.Operator, ImportHelper):
    """Import a run folder of pent-sim, or a .pent mesh, as slices that Blender cuts"""

    bl_idname = "pentimento.import_run"
    bl_label = "Pentimento run"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default="*.pent;*.toml;*.json", options={"HIDDEN"})
    as_one: BoolProperty(
        name="One object", description="All bodies in one mesh instead of an object for each"
    )
    set_time: BoolProperty(
        name="Set frames and rate",
        description="The scene plays the run from beginning to end, at the speed of the simulation",
        default=True,
    )

    def execute(self, context):
        path = os.path.normpath(self.filepath)
        try:
            forget(path)
            view = view_of(path)
            str(view.path).encode()  # as Blender keeps it
            middle = view.middle()
            rate = view.frames_per_second
        except FAILURES as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        run = _add_run(context, view, middle)
        for body in [""] if self.as_one else view.bodies:
            _add_body(context, run, body)
        if self.set_time and rate > 0:
            _set_time(context.scene, view, rate)
        _key_frames(run, view, context.scene.frame_start)
        slicing.refresh(run)
        context.scene.frame_set(context.scene.frame_current)
        context.scene.render.use_lock_interface = True  # meshes change while frames are rendered
        if run.pentimento.message:
            self.report({"WARNING"}, run.pentimento.message)
        return {"FINISHED"}


def _add_run(context, view, middle):
    run = bpy.data.objects.new(view.path.name.removesuffix(".pent"), None)
    context.collection.objects.link(run)
    run.pentimento.dimension = view.dimension
    run.pentimento.offset = middle
    run.pentimento.frame = view.frames[0]
    run.pentimento.path = str(view.path)
    for other in context.selected_objects:
        other.select_set(False)
    run.select_set(True)
    context.view_layer.objects.active = run
    return run


def _add_body(context, run, body):
    name = body or run.name
    thing = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    context.collection.objects.link(thing)
    thing.parent = run
    thing.pentimento_body.run = run
    thing.pentimento_body.body = body
    thing.data.materials.append(_material())
    # Exporters to Alembic and USD write a mesh once only, unless its object has a modifier.
    mark = thing.modifiers.new("Changes from frame to frame", "TRIANGULATE")
    mark.show_viewport = mark.show_render = False


def _material():
    """Shows the attribute of colors; one for all."""
    name = "Pentimento slice"
    material = bpy.data.materials.get(name)
    if material is None:
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        nodes = material.node_tree.nodes
        colors = nodes.new("ShaderNodeVertexColor")
        colors.layer_name = slicing.COLOR
        colors.location = (-250, 250)
        shader = nodes["Principled BSDF"]
        shader.inputs["Roughness"].default_value = 0.45
        material.node_tree.links.new(colors.outputs["Color"], shader.inputs["Base Color"])
    return material


def _set_time(scene, view, rate):
    scene.frame_end = scene.frame_start + view.frames[-1] - view.frames[0]
    scene.render.fps = max(1, round(rate))
    scene.render.fps_base = scene.render.fps / rate


def _key_frames(run, view, start):
    """A frame of the run for each of Blender's, from `start` on; another curve is another speed."""
    first, last = view.frames[0], view.frames[-1]
    for at, frame in ((start, first), (start + last - first, last)):
        run.pentimento.frame = frame
        run.keyframe_insert("pentimento.frame", frame=at)
    for curve in run.animation_data.action.fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    run.pentimento.last = last


def _extend_keys(run, view, scene):
    """The key at the end of a run that has grown goes to its new end, as fast as before, and the
    end of the scene with it; but for keys that say something else by now."""
    before, last = run.pentimento.last, view.frames[-1]
    action = run.animation_data.action if run.animation_data else None
    curve = action.fcurves.find("pentimento.frame") if action else None
    keys = list(curve.keyframe_points) if curve else []
    if last <= before or not keys or keys[-1].co.y != before:
        return
    end = keys[-1].co.x
    if len(keys) == 1:
        _key_frames(run, view, round(end))
    else:
        steps, frames = keys[-1].co - keys[-2].co
        if frames <= 0:
            return
        keys[-1].co = (end + (last - before) * steps / frames, last)
        curve.update()
        run.pentimento.last = last
    if scene.frame_end == end:
        scene.frame_end = math.ceil(curve.keyframe_points[-1].co.x)
    scene.frame_set(scene.frame_current)


class _OfRun:
    """Does something to the run of the active object."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return run_of(context.object) is not None

    def execute(self, context):
        run = run_of(context.object)
        try:
            self.change(run, context)
        except FAILURES as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        if run.pentimento.message:
            self.report({"ERROR"}, run.pentimento.message)
            return {"CANCELLED"}
        return {"FINISHED"}


class PENTIMENTO_OT_reload(_OfRun, bpy.types.Operator):
    """Read the run anew: it has more frames, or other ones, than when it was read"""

    bl_idname = "pentimento.reload"
    bl_label = "Read again"

    def change(self, run, context):
        forget(run.pentimento.path)
        for thing in slicing.bodies_of(run):
            thing.data.pop(slicing.KEY, None)
        _extend_keys(run, view_of(run.pentimento.path), context.scene)
        slicing.refresh(run)


class PENTIMENTO_OT_fit_colors(_OfRun, bpy.types.Operator):
    """Let the colors reach over what the bodies have in this frame and slice"""

    bl_idname = "pentimento.fit_colors"
    bl_label = "Fit colors"

    def change(self, run, context):
        settings = run.pentimento
        view = view_of(settings.path)
        look = look_of(settings, view)
        found = [view.slice(body, look.frame, look.rotate, look.offset) for body in view.bodies]
        ranges = [one.color_range(look.color) for one in found if len(one.points) > 0]
        if ranges:
            settings.low = min(low for low, _ in ranges)
            settings.high = max(high for _, high in ranges)


class PENTIMENTO_OT_middle(_OfRun, bpy.types.Operator):
    """Slice through the middle of the bodies at the start, as pent-slice does by itself"""

    bl_idname = "pentimento.middle"
    bl_label = "Middle"

    def change(self, run, context):
        view = view_of(run.pentimento.path)
        run.pentimento.offset = view.middle(look_of(run.pentimento, view).rotate)


_CLASSES = (
    PENTIMENTO_OT_import,
    PENTIMENTO_OT_reload,
    PENTIMENTO_OT_fit_colors,
    PENTIMENTO_OT_middle,
)


def _menu(menu, _context):
    menu.layout.operator(PENTIMENTO_OT_import.bl_idname, text="Pentimento run or mesh (.pent)")


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.types.TOPBAR_MT_file_import.append(_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
