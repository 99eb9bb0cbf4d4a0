"""Slices of four-dimensional bodies, cut in Blender: docs/blender.md."""

bl_info = {
    "name": "Pentimento slices",
    "description": "Imports runs and meshes of four dimensions, and slices them by any hyperplane",
    "version": (0, 0, 0),  # the zip has that of the project
    "blender": (3, 4, 0),
    "location": "File > Import > Pentimento run; sidebar of the 3D view",
    "category": "Import-Export",
}

import bpy

from . import handlers, operators, panel, settings


def register():
    settings.register()
    operators.register()
    bpy.utils.register_class(panel.PENTIMENTO_PT_slice)
    handlers.register()


def unregister():
    handlers.unregister()
    bpy.utils.unregister_class(panel.PENTIMENTO_PT_slice)
    operators.unregister()
    settings.unregister()
