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
        devices = [d.name for d in taut.devices() if not d.refusal]
    except library.Missing as e:
        return str(e)
    except Exception as e:  # of drivers
        return f"taut is loaded, but: {e}"
    return f"taut {taut.__version__} on {devices[0]}" if devices else "taut is loaded, but there is no OpenCL device"


def register() -> None:
    for c in CLASSES:
        bpy.utils.register_class(c)
    bpy.types.Scene.taut = bpy.props.PointerProperty(type=properties.TautSettings)
    bpy.types.IMAGE_MT_uvs.append(panel.uv_menu)


def unregister() -> None:
    bpy.types.IMAGE_MT_uvs.remove(panel.uv_menu)
    del bpy.types.Scene.taut
    for c in reversed(CLASSES):
        bpy.utils.unregister_class(c)
