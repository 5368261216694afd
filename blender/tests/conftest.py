# SPDX-License-Identifier: MIT
"""Scenes of Blender as a Python module, with the add-on registered."""

import pathlib
import sys

import bpy
import pytest

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import taut_uv  # noqa: E402


@pytest.fixture(scope="session", autouse=True)
def addon():
    taut_uv.register()
    yield
    taut_uv.unregister()


@pytest.fixture(autouse=True)
def scene(addon):
    """An empty scene in object mode."""
    if bpy.context.object is not None and bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for collection in (bpy.data.objects, bpy.data.meshes):
        for block in list(collection):
            collection.remove(block)
    bpy.context.tool_settings.mesh_select_mode = (True, False, False)
    yield
