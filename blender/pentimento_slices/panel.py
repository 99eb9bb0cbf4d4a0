"""The tab Pentimento in the sidebar of the 3D view."""

import bpy

from . import operators
from .settings import run_of


class PENTIMENTO_PT_slice(bpy.types.Panel):
    bl_label = "Slice"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Pentimento"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        run = run_of(context.object)
        if run is None:
            layout.operator(operators.PENTIMENTO_OT_import.bl_idname, text="Import", icon="IMPORT")
            return
        settings = run.pentimento
        if settings.message:
            layout.label(text=settings.message, icon="ERROR")
        layout.prop(settings, "path")
        layout.operator(operators.PENTIMENTO_OT_reload.bl_idname, icon="FILE_REFRESH")
        layout.prop(settings, "frame")
        if settings.dimension == 4:
            self.draw_hyperplane(layout, settings)
        layout.prop(settings, "shading", expand=True)
        layout.prop(settings, "color")
        if settings.color != "body":
            column = layout.column(align=True)
            column.prop(settings, "low")
            column.prop(settings, "high")
            column.operator(operators.PENTIMENTO_OT_fit_colors.bl_idname)

    @staticmethod
    def draw_hyperplane(layout, settings):
        column = layout.column(align=True)
        column.prop(settings, "offset")
        column.operator(operators.PENTIMENTO_OT_middle.bl_idname)
        column = layout.column(align=True)
        for plane in ("xy", "xz", "yz", "xw", "yw", "zw"):
            column.prop(settings, plane)
