# SPDX-License-Identifier: MIT
"""The panel "taut" of the 3D view and of the UV editor."""

from __future__ import annotations

import bpy

from . import running


class _Panel:
    bl_label, bl_category, bl_region_type = "taut", "taut", "UI"

    def draw(self, context):
        layout, settings = self.layout, context.scene.taut
        if running.current is not None:
            layout.label(text=running.current.line)
            layout.operator("taut.stop", icon="CANCEL")
            return
        column = layout.column(align=True)
        self.button(column, "taut.unwrap", settings, "padding", "resolution", "weights", "time_limit")
        self.button(column, "taut.relax", settings, "weights", "time_limit")
        row = column.row(align=True)
        for axis in "uv":
            self.button(row, "taut.relax", settings, "weights", "time_limit", text=f"Relax {axis.upper()}").axis = axis
        self.button(column, "taut.straighten", settings, "time_limit")
        if context.area.type == "IMAGE_EDITOR":
            column.operator_context = "INVOKE_DEFAULT"
            column.operator("taut.live")
        column = layout.column(align=True)
        self.button(
            column, "taut.atlas", settings, "padding", "resolution", "tiles", "density", "weights", "time_limit"
        )
        column.operator("taut.check")
        column = layout.column(align=True)
        for name in ("resolution", "padding", "tiles", "density", "time_limit"):
            column.prop(settings, name)
        ob = context.object
        if ob is not None and ob.type == "MESH":
            layout.prop_search(settings, "weights", ob, "vertex_groups")

    @staticmethod
    def button(layout, name, settings, *options, **more):
        made = layout.operator(name, **more)
        for option in options:
            setattr(made, option, getattr(settings, option))
        return made


class TAUT_PT_view(_Panel, bpy.types.Panel):
    bl_idname, bl_space_type = "TAUT_PT_view", "VIEW_3D"


class TAUT_PT_editor(_Panel, bpy.types.Panel):
    bl_idname, bl_space_type = "TAUT_PT_editor", "IMAGE_EDITOR"


def uv_menu(self, context):
    """Entries of the menu UV."""
    self.layout.separator()
    for name in ("unwrap", "relax", "straighten", "live", "check"):
        self.layout.operator(f"taut.{name}", text=f"{name.capitalize()} (taut)")


CLASSES = [TAUT_PT_view, TAUT_PT_editor]
