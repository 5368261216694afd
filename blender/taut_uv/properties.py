# SPDX-License-Identifier: MIT
"""Options that several operators have, and those that a scene keeps for the panel."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

ENERGIES = [
    ("isometric", "Isometric", "Lengths, angles and areas"),
    ("shape", "Shape", "Angles: as conformal as it can be without folds"),
    ("area", "Area", "Areas count more than angles"),
]


def energy():
    return EnumProperty(
        name="Energy", items=ENERGIES, default="isometric", description="What is kept as it is in space"
    )


def no_overlap():
    return BoolProperty(name="No Overlap", default=False, description="The border of an island must not cross itself")


def weights():
    return StringProperty(name="Weights", default="", description="Vertex group whose weights say how much faces count")


def time_limit():
    return FloatProperty(
        name="Time Limit",
        default=0,
        min=0,
        soft_max=600,
        unit="TIME_ABSOLUTE",
        description="Seconds, after which what is done is kept; 0: none",
    )


def padding():
    return FloatProperty(
        name="Padding", default=2, min=0, max=256, subtype="PIXEL", description="Least distance of islands in texels"
    )


def resolution():
    return IntProperty(
        name="Resolution", default=1024, min=16, max=65536, subtype="PIXEL", description="Texels along a side of a tile"
    )


def tiles():
    return IntProperty(name="UDIM Tiles", default=1, min=1, max=100, description="Ten in a row from 1001 on")


def density():
    return FloatProperty(
        name="Texel Density",
        default=0,
        min=0,
        description="Texels per unit of the scene, on as many tiles as that takes; 0: tiles are filled",
    )


class TautSettings(bpy.types.PropertyGroup):
    """What the panel gives to the operators."""

    padding: padding()
    resolution: resolution()
    tiles: tiles()
    density: density()
    weights: weights()
    time_limit: time_limit()


class TautPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    folder: StringProperty(
        name="Folder of taut",
        subtype="DIR_PATH",
        default="",
        description="Where the Python package taut lies, where it did not come with the add-on",
    )

    def draw(self, context):
        from . import library_state

        self.layout.prop(self, "folder")
        self.layout.label(text=library_state())
