# SPDX-License-Identifier: MIT
"""Commands as operators: at once from scripts, and as a job with progress, Stop and Esc from the user interface."""

from __future__ import annotations

import bpy
import numpy as np

from . import scene
from .core import library
from .core.messages import Trouble
from .core.work import Result, Task

#: The job that runs, for the panel and its button Stop.
current: Task | None = None


def module():
    """The package taut, from where the preferences say."""
    addon = bpy.context.preferences.addons.get(__package__)
    return library.taut(getattr(addon.preferences, "folder", "") if addon and addon.preferences else "")


def told(operator, reader, result: Result, what: str) -> set:
    """Reports what a command has made. What it could not do is a warning that names elements, or an error where it did
    nothing at all; these faces are selected in edit mode."""
    did = bool(result.changed.any()) or result.selected is not None or result.seam is not None
    level = "WARNING" if did else "ERROR"
    for problem in result.problems[:4]:
        operator.report({level}, problem.message)
    if len(result.problems) > 4:
        operator.report({level}, f"and {len(result.problems) - 4} more")
    for note in result.notes:
        operator.report({"INFO"}, note)
    if not result.complete:
        operator.report(
            {"WARNING"}, f"{what} ended early; " + ("what is done is kept" if did else "nothing was done yet")
        )
    elif did:
        numbers = ", ".join(
            f"{name} {value:.4g}" if isinstance(value, float) else f"{name} {value}"
            for name, value in result.numbers.items()
        )
        operator.report({"INFO"}, f"{what}: {numbers}")
    return {"FINISHED"} if did else {"CANCELLED"}


class Command:
    """Base of operators: `command` is a function of core, whose arguments are the operator's properties."""

    bl_options = {"REGISTER", "UNDO"}
    command = None
    makes_map = False
    _timer = None

    @classmethod
    def poll(cls, context):
        return current is None and (
            context.mode == "EDIT_MESH"
            or context.mode == "OBJECT"
            and any(o.type == "MESH" for o in context.selected_objects)
        )

    def arguments(self) -> dict:
        given = {name: getattr(self, name) for name in type(self).__annotations__}
        if "weights" in given:  # the name of a vertex group, which the reader has read
            given["weighted"] = bool(given.pop("weights"))
        return given

    def read(self, context) -> scene.Reader:
        return scene.Reader(
            scene.objects(context),
            new_map=self.makes_map,
            uv_selection=scene.by_uv_selection(context),
            weights=getattr(self, "weights", ""),
        )

    def begin(self, context):
        """The arrays, and the job that works on them. Raises Trouble and library.Missing."""
        taut = module()
        reader = self.read(context)
        return reader, Task(taut, type(self).command, reader.surface, **self.arguments())

    def execute(self, context):
        try:
            reader, task = self.begin(context)
            return self.conclude(context, reader, task)
        except (Trouble, library.Missing) as e:
            self.report({"ERROR"}, str(e))
            return {"CANCELLED"}

    def conclude(self, context, reader, task) -> set:
        """Writes what the job has made. Raises what it raises."""
        try:
            result = task.result()
        except Trouble as e:
            select_problem(reader, e.problem)
            raise
        except Exception as e:  # of the library: a device, a full memory
            self.report({"ERROR"}, f"{self.bl_label}: {e}")
            return {"CANCELLED"}
        if not scene.write(reader, result):
            self.report({"ERROR"}, "the mesh was changed while the job ran; start it again")
            return {"CANCELLED"}
        for problem in result.problems[:1]:
            select_problem(reader, problem)
        return told(self, reader, result, self.bl_label)

    def invoke(self, context, event):
        if context.window is None or bpy.app.background:
            return self.execute(context)
        return self.launch(context)

    def launch(self, context):
        """Starts the job; modal() watches it."""
        global current
        try:
            self._reader, current = self.begin(context)
        except (Trouble, library.Missing) as e:
            self.report({"ERROR"}, str(e))
            return {"CANCELLED"}
        self._task = current
        self._timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def cancel(self, context) -> None:
        """Of Blender, which opens another file or closes the window: nothing is written."""
        global current
        self._task.stop()
        if current is self._task:
            current = None
        self._leave(context)

    def _leave(self, context) -> None:
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        if context.workspace is not None:
            context.workspace.status_text_set(None)

    def modal(self, context, event):
        if current is not self._task:  # it was dropped
            self.cancel(context)
            return {"CANCELLED"}
        if event.type == "ESC" and event.value == "PRESS" and not current.done:
            current.stop()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if not current.done:
            context.workspace.status_text_set(
                f"taut {self.bl_label}: {current.line}   Esc: stop, and keep what is done"
            )
            redraw(context)
            return {"PASS_THROUGH"}
        return self.end(context)

    def end(self, context):
        """Of a job that is done."""
        global current
        task, current = current, None
        self._leave(context)
        redraw(context)
        try:
            return self.conclude(context, self._reader, task)
        except (Trouble, library.Missing) as e:
            self.report({"ERROR"}, str(e))
            return {"CANCELLED"}


@bpy.app.handlers.persistent
def drop(*_) -> None:
    """Ends the job that runs: before another file is opened, whose meshes are others, and as the add-on is disabled."""
    global current
    if current is not None:
        current.stop()
        current = None


def select_problem(reader, problem) -> None:
    """Selects the faces that a problem names, of objects that are edited."""
    if len(problem.faces) == 0:
        return
    named = dict(reader.surface.named("face", problem.faces))
    for name in reader.names:
        ob = scene.named(name)
        if ob is not None and ob.mode == "EDIT":
            faces = np.zeros(len(ob.data.polygons), bool)
            faces[named.get(name, [])] = True
            scene.select_edited(ob, faces)


def redraw(context) -> None:
    for area in context.screen.areas if context.screen else []:
        if area.type in ("VIEW_3D", "IMAGE_EDITOR"):
            area.tag_redraw()
