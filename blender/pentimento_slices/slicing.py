"""Meshes that are slices: cut anew where frame or hyperplane are others than they were cut for."""

import sys

import bpy
import numpy as np

from .settings import look_of
from .views import FAILURES, Error, one_line, view_of

KEY = "pentimento_slice"  # of a mesh: the look that it was cut for
COLOR = "Color"  # the attribute; by "color" Cycles understands that of smoke


def bodies_of(run):
    """The mesh objects that are sliced for a run."""
    return [thing for thing in bpy.data.objects if thing.pentimento_body.run == run]


def refresh(run, depsgraph=None):
    """Cuts the bodies of a run where their slices are not those of its settings, as they are
    animated in a dependency graph or as they stand. What is wrong goes to `message`: the meshes
    stay as they are then."""
    if not run.pentimento.path:
        return
    settings = run.evaluated_get(depsgraph).pentimento if depsgraph else run.pentimento
    try:
        view = view_of(settings.path)
        look = look_of(settings, view)
        if run.pentimento.dimension != view.dimension:
            run.pentimento.dimension = view.dimension
        for thing in bodies_of(run):
            _cut(thing, view, look)
        _tell(run, "")
    except FAILURES as error:
        _tell(run, one_line(error))


def refresh_all(depsgraph=None):
    for thing in bpy.data.objects:
        if thing.pentimento.path:
            refresh(thing, depsgraph)


def _tell(run, message):
    if run.pentimento.message != message:
        run.pentimento.message = message
        if message:
            print(f"pentimento: {message}", file=sys.stderr)


def _cut(thing, view, look):
    name = thing.pentimento_body.body
    key = f"{name} {look}"
    if thing.data.get(KEY) == key:
        return
    if thing.data.is_editmode:
        raise Error(f"{thing.name}: is in Edit Mode; the slice is cut when it is left")
    shading = look.shading == "SMOOTH"
    surfaces = [
        view.slice(body, look.frame, look.rotate, look.offset, shading=shading)
        for body in ([name] if name else view.bodies)
    ]
    # All that can fail comes before the mesh is changed.
    colors = np.concatenate([s.colors(look.color, look.low, look.high) for s in surfaces])
    if thing.data.users > 1:  # a linked copy, which may be of a run with another slice
        thing.data = thing.data.copy()
    fill(thing.data, surfaces, colors)
    thing.data[KEY] = key


def fill(mesh, surfaces, colors):
    """Surfaces as one mesh, in place of what it was: x, -z, y of Blender are our x, y, z."""
    mesh.clear_geometry()
    starts = np.cumsum([0, *(len(surface.points) for surface in surfaces)])
    points = np.concatenate([surface.points for surface in surfaces])
    triangles = np.concatenate(
        [surface.triangles + start for surface, start in zip(surfaces, starts)]
    ).astype(np.int32)
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", _upright(points).astype(np.float32).ravel())
    mesh.loops.add(triangles.size)
    mesh.loops.foreach_set("vertex_index", triangles.ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    if not bpy.types.MeshPolygon.bl_rna.properties["loop_total"].is_readonly:
        mesh.polygons.foreach_set("loop_total", np.full(len(triangles), 3, np.int32))
    is_smooth = all(surface.normals is not None for surface in surfaces)
    mesh.polygons.foreach_set("use_smooth", np.full(len(triangles), is_smooth))
    mesh.update(calc_edges=True)
    _add_attributes(mesh, surfaces, colors)
    if is_smooth and len(triangles) > 0:
        normals = np.concatenate([surface.normals for surface in surfaces]).reshape(-1, 3)
        if hasattr(mesh, "use_auto_smooth"):  # Blender 4.1 and later have no such switch
            mesh.use_auto_smooth = True
        mesh.normals_split_custom_set(_upright(normals))


def _upright(vectors):
    return np.column_stack([vectors[:, 0], -vectors[:, 2], vectors[:, 1]])


def _add_attributes(mesh, surfaces, colors):
    """The colors first: a quantity of that name gets a number behind it, by Blender."""
    attribute = mesh.attributes.new(COLOR, "FLOAT_COLOR", "POINT")
    opaque = np.column_stack([colors, np.ones(len(colors), np.float32)])
    attribute.data.foreach_set("color", opaque.astype(np.float32).ravel())
    mesh.color_attributes.active_color_index = mesh.color_attributes.find(COLOR)
    for name in surfaces[0].attributes:
        if any(name not in surface.attributes for surface in surfaces):
            continue
        values = np.concatenate([surface.attributes[name] for surface in surfaces])
        _new_attribute(mesh, name).data.foreach_set("value", values.astype(np.float32))


def _new_attribute(mesh, name):
    """A number for each vertex; with a "_" behind names that Blender keeps for itself."""
    attribute = mesh.attributes.new(name, "FLOAT", "POINT")
    return attribute or mesh.attributes.new(f"{name}_", "FLOAT", "POINT")
