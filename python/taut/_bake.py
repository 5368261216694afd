# SPDX-License-Identifier: MIT
"""Textures of one atlas made for another."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays, _options
from ._arrays import ArrayLike
from ._call import named
from ._native import native
from .errors import ParameterError


#: What the library calls arguments.
_NAMES = {"old": "image", "from": "old_uv", "to": "new_uv", "width": "size", "height": "size", "new_width": "size",
          "new_height": "size", "channels": "image"}


def _corners(name: str, uv: ArrayLike) -> NDArray[Any]:
    rows = _arrays.array(name, uv)
    if rows.ndim != 3 or rows.shape[1:] != (3, 2):
        raise ParameterError(f"{name}: has the shape {rows.shape}, but must be (m, 3, 2)", field=name)
    return rows.reshape(-1, 2)


def bake(image: ArrayLike, old_uv: ArrayLike, new_uv: ArrayLike, *, size: int | tuple[int, int] | None = None,
         filter: str = "bilinear", wrap: str = "repeat", samples: int = 1, gutter: float | None = None,
         device: str | int | None = None) -> NDArray[np.float64]:
    """Make the texture for a new atlas of a surface that shows on it what the old one shows through the old atlas.

    Parameters
    ----------
    image : (height, width) or (height, width, channels) array-like
        Linear numbers, the top row first, 1 to 4 channels.
    old_uv, new_uv : (m, 3, 2) array-like
        Texture coordinates of the corners of the same triangles, v upwards; NaN: left out.
    size : int or (width, height), optional
        Texels of the new image; None: those of the old one.
    filter : "bilinear" or "nearest"
        Between old texels; "nearest" for labels.
    wrap : "repeat", "clamp" or "mirror"
    samples : int
        Places along each side of a texel of which the mean is taken.
    gutter : float, optional
        Texels around charts that get the nearest texel of a chart; None: all.
    device : str or int, optional

    Returns
    -------
    (height, width) or (height, width, channels) array

    Examples
    --------
    >>> import numpy as np, taut
    >>> image = np.array([[1.0, 2.0], [3.0, 4.0]])
    >>> old = [[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]]
    >>> new = np.array(old)[:, :, ::-1]                        # mirrored along the diagonal
    >>> taut.bake(image, old, new).round(3).tolist()
    [[4.0, 2.0], [3.0, 1.0]]
    """
    old = _arrays.array("image", image)
    if old.ndim not in (2, 3):
        raise ParameterError(f"image: has {old.ndim} axes, but must have 2 or 3", field="image")
    if (np.isfinite(old) & (np.abs(old) > np.finfo(np.float32).max)).any():
        raise ParameterError("image: has numbers beyond single precision; scale them", field="image")
    options: dict[str, Any] = {"height": old.shape[0], "width": old.shape[1],
                               "channels": old.shape[2] if old.ndim == 3 else 1, "filter": filter, "wrap": wrap,
                               "samples": _arrays.whole("samples", samples),
                               "gutter": math.inf if gutter is None else _arrays.number("gutter", gutter)}
    if size is not None:
        both: Any = (size, size) if _arrays.shape(size) == () else size
        try:
            width, height = (_arrays.whole("size", n) for n in both)
        except (TypeError, ValueError):
            raise ParameterError(f"size: is {size!r}, but must be one number of texels, or (width, height)",
                                 field="size") from None
        if width < 1 or height < 1:
            raise ParameterError(f"size: is {width} x {height}, but both must be positive", field="size")
        options["new_width"], options["new_height"] = width, height
    if device is not None:
        options["device"] = _options.device(device)
    rows = np.ascontiguousarray(old[::-1]).reshape(-1)
    corners = _corners("old_uv", old_uv), _corners("new_uv", new_uv)
    if len(corners[0]) != len(corners[1]):
        raise ParameterError(f"new_uv: has {len(corners[1]) // 3} triangles, but old_uv has {len(corners[0]) // 3}; "
                             "give each in both", field="new_uv")
    with named(_NAMES):
        texels, _, width, height = native().bake(rows, *corners, options)
    made: NDArray[np.float64] = texels.reshape((height, width, *old.shape[2:]))[::-1]
    return made
