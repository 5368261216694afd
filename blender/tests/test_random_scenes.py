# SPDX-License-Identifier: MIT
"""Random scenes, read back and judged; random_scenes.py runs more of them."""

import bpy
import judge
import numpy as np
import pytest
from random_scenes import judged
from scenes import made


@pytest.mark.parametrize("command", ["unwrap", "atlas"])
@pytest.mark.parametrize("seed", [4, 16, 19, 25, 31])
def test_a_random_scene_has_no_flips_and_no_overlaps(seed, command):
    assert judged(seed, command) is None


def quads_with_a_straight_corner(height, n=6):
    """A row of quads, and on it triangles whose base has a corner in its middle: Blender cuts it off there."""
    wave = lambda x, y: height * np.sin(3 * x + 2 * y)
    V = [(x / 2, -0.5, 0) for x in range(2 * n + 1)] + [(x / 2, 0, 0) for x in range(2 * n + 1)]
    V += [(x + 0.5, 1, 0) for x in range(n)]
    V = [(x, y, wave(x, y)) for x, y, _ in V]
    F = [(i, i + 1, 2 * n + 2 + i, 2 * n + 1 + i) for i in range(2 * n)]
    base, top = 2 * n + 1, 4 * n + 2
    F += [(base + 2 * k, base + 2 * k + 1, base + 2 * k + 2, top + k) for k in range(n)]
    F += [(base + 2 * k + 2, top + k + 1, top + k) for k in range(n - 1)]
    return made("Strip", V, F)


@pytest.mark.parametrize("command", [bpy.ops.taut.unwrap, bpy.ops.taut.atlas])
@pytest.mark.parametrize("height", [0, 1e-6])
def test_blender_reads_no_flips_where_a_corner_is_straight(command, height):
    ob = quads_with_a_straight_corner(height)
    read = judge.Read(ob)
    t = read.V[read.vertex[read.triangles]]
    area = np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1)
    assert area.min() <= height
    assert command() == {"FINISHED"}
    assert judge.flips(judge.Read(ob)) == 0


def test_polygons_that_are_concave_in_the_map_alone_are_told():
    from taut_uv.core.polygons import tell_concave
    from taut_uv.core.surface import from_polygons
    from taut_uv.core.work import Result

    s = from_polygons([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    result = Result.of(s)
    result.changed[:] = True
    result.uv = np.array([(0, 0), (1, 0), (0.4, 0.4), (0, 1.0)])
    tell_concave(s, result)
    assert "face 0: convex, but not in the map" in result.notes[0]
    result.notes.clear()
    result.uv = np.array([(0, 0), (0, 1), (1, 1), (1, 0.0)])  # mirrored as a whole
    tell_concave(s, result)
    assert not result.notes
