# SPDX-License-Identifier: MIT
"""The operators: what each asks for, and the function of core that does it."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty

from . import properties, running
from .core.atlas import atlas
from .core.check import check
from .core.relax import relax
from .core.straighten import straighten
from .core.unwrap import unwrap
from .running import Command


class TAUT_OT_unwrap(Command, bpy.types.Operator):
    """Lay islands flat without folds. Pinned UVs keep their coordinates, bit for bit"""

    bl_idname, bl_label = "taut.unwrap", "Unwrap"
    command = staticmethod(unwrap)
    makes_map = True

    energy: properties.energy()
    no_overlap: properties.no_overlap()
    cut: BoolProperty(
        name="Cut Where Needed",
        default=False,
        description="Cut islands that cannot be laid flat, and mark the cuts as seams",
    )
    pack: BoolProperty(name="Pack", default=True, description="Pack islands without pins into the unit square")
    rotate: BoolProperty(name="Rotate", default=True, description="Islands may be rotated where that packs them better")
    weights: properties.weights()
    padding: properties.padding()
    resolution: properties.resolution()
    time_limit: properties.time_limit()


class TAUT_OT_relax(Command, bpy.types.Operator):
    """Make selected faces less distorted where they lie. All other UVs, and pins, stay, bit for bit"""

    bl_idname, bl_label = "taut.relax", "Relax"
    command = staticmethod(relax)

    axis: EnumProperty(
        name="Axis",
        default="both",
        items=[
            ("both", "U and V", "Both coordinates may change"),
            ("u", "U only", "V of each vertex stays, bit for bit"),
            ("v", "V only", "U of each vertex stays, bit for bit"),
        ],
    )
    hold_border: BoolProperty(name="Hold Border", default=False, description="Open borders of islands stay, too")
    energy: properties.energy()
    no_overlap: properties.no_overlap()
    weights: properties.weights()
    time_limit: properties.time_limit()


class TAUT_OT_straighten(Command, bpy.types.Operator):
    """Make selected lines of edges straight along an axis; their islands follow without folding"""

    bl_idname, bl_label = "taut.straighten", "Straighten"
    command = staticmethod(straighten)

    axis: EnumProperty(
        name="Axis",
        default="auto",
        items=[
            ("auto", "Auto", "The axis along which a line is longer"),
            ("u", "U", "Lines of equal V"),
            ("v", "V", "Lines of equal U"),
        ],
    )
    spacing: EnumProperty(
        name="Spacing",
        default="free",
        items=[
            ("free", "Free", "Where the island is least distorted"),
            ("length", "Length", "As far apart as in space"),
        ],
    )
    energy: properties.energy()
    no_overlap: properties.no_overlap()
    time_limit: properties.time_limit()


class TAUT_OT_atlas(Command, bpy.types.Operator):
    """Make one atlas of all selected objects: charts, flattened, packed, without flips and overlaps"""

    bl_idname, bl_label = "taut.atlas", "Atlas"
    command = staticmethod(atlas)
    makes_map = True

    charts: EnumProperty(
        name="Charts",
        default="auto",
        items=[("auto", "Make", "Charts are made"), ("keep", "Keep", "Charts are those between the seams")],
    )
    prefer: EnumProperty(
        name="Prefer",
        default="seams",
        items=[
            ("seams", "Short Seams", "Few charts along short seams"),
            ("packing", "Packing", "More charts, which fill tiles well"),
            ("one", "One", "One chart a part, where it can be"),
        ],
    )
    keep_seams: BoolProperty(name="Keep Seams", default=False, description="Seams that are marked are seams of it, too")
    mark_seams: BoolProperty(name="Mark Seams", default=True, description="Mark the seams of the atlas, clear others")
    symmetric: BoolProperty(
        name="Symmetric",
        default=False,
        description="Charts are mirror images of each other, in the plane of symmetry of the selection",
    )
    max_distortion: FloatProperty(
        name="Max Distortion",
        default=0,
        min=0,
        description="Bound of the mean energy of a chart, above 4, which is none; 0: the usual one",
    )
    rotate: BoolProperty(name="Rotate", default=True, description="Charts may be rotated")
    tiles: properties.tiles()
    density: properties.density()
    weights: properties.weights()
    padding: properties.padding()
    resolution: properties.resolution()
    time_limit: properties.time_limit()


class TAUT_OT_check(Command, bpy.types.Operator):
    """Select faces that are flipped, or overlap others, in the UV map"""

    bl_idname, bl_label = "taut.check", "Check"
    command = staticmethod(check)

    flips: BoolProperty(name="Flipped", default=True, description="Select faces that are flipped within their islands")
    overlaps: BoolProperty(name="Overlapping", default=True, description="Select faces that overlap others")


class TAUT_OT_stop(bpy.types.Operator):
    """End the job that runs, and keep what is done"""

    bl_idname, bl_label, bl_options = "taut.stop", "Stop", {"INTERNAL"}

    @classmethod
    def poll(cls, context):
        return running.current is not None

    def execute(self, context):
        running.current.stop()
        return {"FINISHED"}


CLASSES = [TAUT_OT_unwrap, TAUT_OT_relax, TAUT_OT_straighten, TAUT_OT_atlas, TAUT_OT_check, TAUT_OT_stop]
