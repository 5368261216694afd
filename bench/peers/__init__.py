# SPDX-License-Identifier: MIT
"""Peers of taut, what judges them, and the page of results."""

ATLAS = ["taut", "taut for packing", "taut one line of xatlas", "xatlas", "uvunwrap", "geotex", "pymeshlab voronoi",
         "open3d uvatlas", "blender smart project"]
DISK = ["taut unwrap", "libigl lscm", "libigl arap", "libigl slim", "pymeshlab harmonic", "pymeshlab lscm",
        "blender angle based", "blender conformal", "blender minimum stretch"]

VOLUME = ["taut deform", "libigl arap 3D", "libigl slim 3D", "felupe neo-Hooke"]


def peers_of(kind):
    return {"atlas": ATLAS, "disk": DISK, "volume": VOLUME}[kind]
