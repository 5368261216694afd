# SPDX-License-Identifier: MIT
"""Meshes of trimesh."""

from __future__ import annotations

from typing import Any

from ._atlas import atlas
from ._maps import square
from ._maps import unwrap as _map


def unwrap(mesh: Any, image: Any = None, *, one_chart: bool = False, **options: Any) -> Any:
    """The same mesh with texture coordinates, as `trimesh.Trimesh.unwrap` returns it. They are numbers of float32, as
    models are written with, and certified as these.

    Parameters
    ----------
    mesh : trimesh.Trimesh
    image : PIL.Image, optional
        For the material.
    one_chart : bool
        Whether the mesh is mapped as one chart (`taut.unwrap`, cut open where it needs to be), not as an atlas.
    options
        Of `taut.atlas` or `taut.unwrap`.
    """
    import trimesh

    textured: Any = trimesh.visual.TextureVisuals

    if one_chart:
        flat = _map(mesh.vertices, mesh.faces, **{"cut": True, **square(options), "single": True, **options})
        whole = flat.faces is None or flat.vmapping is None
        vmapping, faces, uv = slice(None) if whole else flat.vmapping, mesh.faces if whole else flat.faces, flat.uv
    else:
        vmapping, faces, uv = atlas(mesh.vertices, mesh.faces, **{"single": True, **options})
    return trimesh.Trimesh(
        vertices=mesh.vertices[vmapping],
        faces=faces,
        visual=textured(uv=uv, image=image),
        process=False,
    )
