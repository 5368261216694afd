# SPDX-License-Identifier: MIT
"""UV maps that never fold, by taut: an add-on for Blender 4.2 and later."""

bl_info = {
    "name": "taut UV",
    "author": "taut",
    "version": (1, 0, 0),
    "blender": (4, 2, 0),
    "location": "3D View and UV Editor > Sidebar > taut",
    "description": "Unwrap, relax, straighten, drag and pack UV maps that never fold",
    "category": "UV",
}

import bpy

from . import dragging, operators, panel, properties, running
from .core import library

CLASSES = [
    properties.TautSettings,
    properties.TautPreferences,
    *operators.CLASSES,
    dragging.TAUT_OT_live,
    *panel.CLASSES,
]


def library_state() -> str:
    """A line about the package taut."""
    try:
        taut = running.module()
        usable = [d for d in taut.devices() if not d.refusal]
    except library.Missing as e:
        return str(e)
    except Exception as e:  # of drivers
        return f"taut is loaded, but: {e}"
    # Unless TAUT_DEVICE says otherwise: a GPU with double precision, else the host, which is the last one.
    device = next((d for d in usable if d.kind == "GPU" and d.double_precision), usable[-1])
    return f"taut {taut.__version__} on {device.name}"


def register() -> None:
    for c in CLASSES:
        bpy.utils.register_class(c)
    bpy.types.Scene.taut = bpy.props.PointerProperty(type=properties.TautSettings)
    bpy.types.IMAGE_MT_uvs.append(panel.uv_menu)
    bpy.app.handlers.load_pre.append(running.drop)


def unregister() -> None:
    bpy.app.handlers.load_pre.remove(running.drop)
    running.drop()
    bpy.types.IMAGE_MT_uvs.remove(panel.uv_menu)
    del bpy.types.Scene.taut
    for c in reversed(CLASSES):
        bpy.utils.unregister_class(c)
