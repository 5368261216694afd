# SPDX-License-Identifier: MIT
"""Volumes: a bar of tetrahedra whose ends are pinned, one of them turned; what deforms it; what judges that, with numpy alone."""

from importlib.metadata import version

import numpy as np


def bar(n, length, degrees):
    """A bar of n by n by length cubes, six tetrahedra each: V, T, pinned vertices and where they go."""
    z, y, x = np.meshgrid(np.arange(length + 1), np.arange(n + 1), np.arange(n + 1), indexing="ij")
    V = np.c_[x.ravel(), y.ravel(), z.ravel()] / n
    k = n + 1
    corner = [w % 2 + k * (w // 2 % 2) + k * k * (w // 4) for w in range(8)]
    first = [a + k * b + k * k * c for c in range(length) for b in range(n) for a in range(n)]
    ways = [(0, 1, 3), (0, 2, 6), (0, 4, 5), (0, 5, 1), (0, 3, 2), (0, 6, 4)]
    T = np.array([[f + corner[p], f + corner[q], f + corner[r], f + corner[7]] for f in first for p, q, r in ways])
    end = V[:, 2] == V[:, 2].max()
    b = np.flatnonzero((V[:, 2] == 0) | end)
    bc, angle = V[b].copy(), np.radians(degrees)
    middle, turn = np.array([0.5, 0.5]), np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    bc[end[b], :2] = (V[b][end[b], :2] - middle) @ turn + middle
    return V, T, b, bc


def taut_deform(V, T, b, bc):
    import taut
    return (lambda: taut.deform(V, T, b, bc).x), taut.__version__


def igl_arap(V, T, b, bc):
    import igl

    def run():
        data = igl.ARAPData()
        igl.arap_precomputation(V, T.astype(np.int64), 3, b.astype(np.int64), data)
        x = V.copy()
        for _ in range(100):
            x = np.asarray(igl.arap_solve(bc, data, np.ascontiguousarray(x)))
        return x
    return run, version("libigl")


def igl_slim(V, T, b, bc):
    import igl

    def run():
        kind = igl.MappingEnergyType.SYMMETRIC_DIRICHLET if hasattr(igl, "MappingEnergyType") \
            else igl.pyigl_core.MappingEnergyType.SYMMETRIC_DIRICHLET
        data = igl.slim_precompute(np.asfortranarray(V), np.asfortranarray(T, dtype=np.int32), np.asfortranarray(V), kind,
                                   b.astype(np.int32), np.asfortranarray(bc), 1e5)
        return np.asarray(igl.slim_solve(data, 20))
    return run, version("libigl")


def felupe(V, T, b, bc):
    import felupe as fem

    def run():
        region = fem.RegionTetra(fem.Mesh(V, T, "tetra"))
        field = fem.FieldContainer([fem.Field(region, dim=3)])
        mask = np.zeros(len(V), dtype=bool)
        mask[b] = True
        moved = np.zeros_like(V)
        moved[b] = bc - V[b]
        held = fem.Boundary(field[0], mask=mask)
        body = fem.SolidBody(fem.NeoHookeCompressible(mu=1.0, lmbda=1.0), field)
        # The turn of the ends in ten steps, each a Newton of its own: in one it does not converge.
        steps = 10
        for s in range(1, steps + 1):
            held.value = (moved[b] * s / steps).ravel()
            dof0, dof1 = fem.dof.partition(field, {"held": held})
            external = fem.dof.apply(field, {"held": held}, dof0)
            fem.newtonrhapson(items=[body], dof0=dof0, dof1=dof1, ext0=external, verbose=0)
        return V + field[0].values
    return run, version("felupe")


PEERS = {"taut deform": taut_deform, "libigl arap 3D": igl_arap, "libigl slim 3D": igl_slim, "felupe neo-Hooke": felupe}


def judge(V, T, b, bc, x):
    """Inverted tetrahedra, mean distortion |S|^2 |S^-1|^2 / 9 (1 for similarities), and how far pins are from their places."""
    if x.shape != V.shape or not np.isfinite(x).all():
        return {"error": "coordinates that are not finite, or of another number"}
    rest = np.stack([V[T[:, k]] - V[T[:, 0]] for k in (1, 2, 3)], 2)
    image = np.stack([x[T[:, k]] - x[T[:, 0]] for k in (1, 2, 3)], 2)
    S = image @ np.linalg.inv(rest)
    det = np.linalg.det(S)
    good = det > 0
    with np.errstate(all="ignore"):
        E = (S[good] ** 2).sum((1, 2)) * (np.linalg.inv(S[good]) ** 2).sum((1, 2)) / 9
    return {"flips": int((~good).sum()), "energy": float(E.mean()) if good.any() else float("inf"), "smallest": float(det.min()),
            "pins": float(np.abs(x[b] - bc).max())}
