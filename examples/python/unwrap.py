# SPDX-License-Identifier: MIT
"""unwrap.py SURFACE OUT.obj: flattens a surface, or makes charts of one that is no disk."""

import sys

import taut

mesh = taut.read(sys.argv[1])
try:
    made = taut.unwrap(*mesh, progress=sys.stderr.isatty())
    print(f"one chart, E {made.energy:.3f}, {'certified' if made.certified else 'not certified'}")
except taut.MeshError as e:
    print(f"{e}; so it gets an atlas")
    made = taut.atlas(*mesh)
    print(f"{made.charts} charts, E {made.distortion:.3f}, {made.report['overlaps']} overlaps")
taut.write(sys.argv[2], like=mesh, uv=made)
