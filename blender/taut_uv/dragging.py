# SPDX-License-Identifier: MIT
"""Live: the modal operator that drags selected UV vertices. What a frame does is in core/live.py."""

from __future__ import annotations

import bpy
from bpy.props import FloatVectorProperty

from . import running, scene
from .core import library
from .core.live import Drag
from .core.messages import Trouble


class Canvas:
    """The coordinates that a drag changes, in the meshes of the scene."""

    def __init__(self, reader, drag: Drag) -> None:
        s = reader.surface
        self._parts = []
        for k, name in enumerate(reader.names):
            own = (drag.corners >= s.first_corner[k]) & (drag.corners < s.first_corner[k + 1])
            if own.any():
                self._parts.append((name, own, (drag.corners[own] - s.first_corner[k]).tolist()))
        self._edited = {}

    def draw(self, uv) -> None:
        for name, own, corners in self._parts:
            ob = scene.named(name)
            if ob.mode == "EDIT":
                if name not in self._edited:
                    self._edited[name] = scene.EditedMap(ob)
                self._edited[name].write(corners, uv[own])
            else:
                scene.write_map(ob.data, corners, uv[own])


class TAUT_OT_live(bpy.types.Operator):
    """Drag selected UV vertices: their islands follow, without folds, in every frame. Pinned UVs stay"""

    bl_idname, bl_label = "taut.live", "Live"
    bl_options = {"REGISTER", "UNDO", "GRAB_CURSOR", "BLOCKING"}

    _timer = None

    shift: FloatVectorProperty(name="Shift", size=2, default=(0, 0), description="By how much the vertices are moved")

    @classmethod
    def poll(cls, context):
        return running.current is None and context.mode == "EDIT_MESH"

    def begin(self, context) -> None:
        taut = running.module()
        self._reader = scene.Reader(scene.objects(context), uv_selection=scene.by_uv_selection(context))
        self._drag = Drag(taut, self._reader.surface, self._reader.grabbed)
        self._canvas = Canvas(self._reader, self._drag)

    def execute(self, context):
        try:
            self.begin(context)
        except (Trouble, library.Missing) as e:
            self.report({"ERROR"}, str(e))
            return {"CANCELLED"}
        return self.conclude(self.shift)

    def conclude(self, shift):
        self._canvas.draw(self._drag.finish(shift))
        if self._drag.distance > 0:
            why = f": {self._drag.reason}" if self._drag.reason else ""
            self.report(
                {"WARNING"},
                f"the vertices stopped {self._drag.distance:.3g} before their places, where the map would fold{why}",
            )
        self._drag.close()
        return {"FINISHED"}

    def invoke(self, context, event):
        if context.region is None or context.space_data is None or context.space_data.type != "IMAGE_EDITOR":
            self.report({"ERROR"}, "Live drags in the UV editor; start it there")
            return {"CANCELLED"}
        try:
            self.begin(context)
        except (Trouble, library.Missing) as e:
            self.report({"ERROR"}, str(e))
            return {"CANCELLED"}
        self._from = self.place(context, event)
        self._timer = context.window_manager.event_timer_add(1 / 60, window=context.window)
        context.window_manager.modal_handler_add(self)
        context.workspace.status_text_set("taut Live: move the mouse; click: keep, Esc: as before")
        return {"RUNNING_MODAL"}

    @staticmethod
    def place(context, event):
        return context.region.view2d.region_to_view(event.mouse_region_x, event.mouse_region_y)

    def modal(self, context, event):
        try:
            if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
                self.leave(context)
                self._canvas.draw(self._drag.before())
                self._drag.close()
                return {"CANCELLED"}
            if event.type in {"LEFTMOUSE", "RET", "NUMPAD_ENTER"} and event.value == "PRESS":
                self.leave(context)
                return self.conclude(self.shift)
            if event.type == "MOUSEMOVE":
                here = self.place(context, event)
                self.shift = (here[0] - self._from[0], here[1] - self._from[1])
            elif event.type == "TIMER":
                self._canvas.draw(self._drag.frame(self.shift))
        except Exception as e:  # of a device, or of meshes that are gone
            self.leave(context)
            self._drag.close()
            self.report({"ERROR"}, f"{self.bl_label}: {e}")
            return {"CANCELLED"}
        return {"RUNNING_MODAL"}

    def cancel(self, context) -> None:
        """Of Blender, too, which opens another file or closes the window."""
        self.leave(context)
        self._drag.close()

    def leave(self, context) -> None:
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        if context.workspace is not None:
            context.workspace.status_text_set(None)
