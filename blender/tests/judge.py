# SPDX-License-Identifier: MIT
"""Judges UV maps as read back from meshes of the scene, in rational numbers, by no code of taut or the add-on."""

from fractions import Fraction

import numpy as np


class Read:
    """What an object's mesh holds now."""

    def __init__(self, ob):
        if ob.mode == "EDIT":
            ob.update_from_editmode()
            mesh = ob.data.copy()  # the copy is no mesh that is edited
        else:
            mesh = ob.data
        mesh.calc_loop_triangles()
        self.V = np.array([ob.matrix_world @ v.co for v in mesh.vertices])
        self.vertex = np.array([loop.vertex_index for loop in mesh.loops])
        self.polygons = [list(p.loop_indices) for p in mesh.polygons]
        self.triangles = np.array([list(t.loops) for t in mesh.loop_triangles]).reshape(-1, 3)
        self.of = np.array([t.polygon_index for t in mesh.loop_triangles])
        layer = mesh.uv_layers.active
        self.uv = np.array([u.vector[:] for u in layer.uv]) if layer else None
        self.edges = {tuple(sorted(e.vertices)): e.use_seam for e in mesh.edges}
        self.seams = {k for k, seam in self.edges.items() if seam}
        self.selected = np.array([p.select for p in mesh.polygons])

    def tri(self):
        return self.uv[self.triangles]


def exact(t):
    """Twice the signed area of a triangle of float coordinates."""
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(float(c)) for c in p] for p in t)
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


def signs(t):
    d = (t[:, 1, 0] - t[:, 0, 0]) * (t[:, 2, 1] - t[:, 0, 1]) - (t[:, 1, 1] - t[:, 0, 1]) * (t[:, 2, 0] - t[:, 0, 0])
    size = np.abs(t - t[:, :1]).max((1, 2)) ** 2
    s = np.sign(d).astype(int)
    for i in np.flatnonzero(np.abs(d) <= 1e-12 * size + 1e-300):
        x = exact(t[i])
        s[i] = (x > 0) - (x < 0)
    return s


def islands(r):
    """The part of each polygon, by edges whose coordinates agree on both sides."""
    parent = list(range(len(r.polygons)))

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    seen = {}
    for p, loops in enumerate(r.polygons):
        for k, a in enumerate(loops):
            b = loops[(k + 1) % len(loops)]
            ends = sorted([(r.vertex[a], *r.uv[a]), (r.vertex[b], *r.uv[b])])
            key = tuple(tuple(map(float, e)) for e in ends)
            if key in seen:
                parent[root(p)] = root(seen[key])
            seen[key] = p
    return np.array([root(p) for p in range(len(r.polygons))])


def torn(r):
    """Edges with two polygons whose coordinates differ."""
    sides = {}
    for loops in r.polygons:
        for k, a in enumerate(loops):
            b = loops[(k + 1) % len(loops)]
            key = tuple(sorted((int(r.vertex[a]), int(r.vertex[b]))))
            sides.setdefault(key, []).append({int(r.vertex[a]): tuple(r.uv[a]), int(r.vertex[b]): tuple(r.uv[b])})
    return {key for key, s in sides.items() if len(s) == 2 and s[0] != s[1]}


def _flipped(r):
    """Which triangles run against the most of their island, or are flat."""
    s, part = signs(r.tri()), islands(r)[r.of]
    area = np.abs(_areas(r.tri()))
    bad = np.zeros(len(s), bool)
    for k in np.unique(part):
        own = part == k
        way = 1 if (s[own] * area[own]).sum() >= 0 else -1
        bad |= own & (s * way <= 0)
    return bad


def flips(r):
    """How many triangles run against the most of their island, or are flat."""
    return int(_flipped(r).sum())


def flipped_polygons(r):
    """Polygons with such triangles."""
    return sorted({int(p) for p in r.of[_flipped(r)]})


def mirrored(r):
    """Islands that are mirrored as a whole."""
    s, part = signs(r.tri()) * np.abs(_areas(r.tri())), islands(r)[r.of]
    return sum(s[part == k].sum() < 0 for k in np.unique(part))


def _areas(t):
    return (
        (t[:, 1, 0] - t[:, 0, 0]) * (t[:, 2, 1] - t[:, 0, 1]) - (t[:, 1, 1] - t[:, 0, 1]) * (t[:, 2, 0] - t[:, 0, 0])
    ) / 2


def _clip(subject, a, b):
    """The part of a convex polygon to the left of a line."""
    side = [(b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) for p in subject]
    out = []
    for i, p in enumerate(subject):
        q, s, t = subject[(i + 1) % len(subject)], side[i], side[(i + 1) % len(subject)]
        if s >= 0:
            out.append(p)
        if (s > 0 > t) or (s < 0 < t):
            w = s / (s - t)
            out.append((p[0] + w * (q[0] - p[0]), p[1] + w * (q[1] - p[1])))
    return out


def common_area(p, q):
    """Of two triangles, exact: one is clipped by the sides of the other."""
    p, q = ([tuple(Fraction(float(c)) for c in x) for x in t] for t in (p, q))
    if _twice(q) < 0:
        q = q[::-1]
    for k in range(3):
        if len(p) < 3:
            return Fraction(0)
        p = _clip(p, q[k], q[(k + 1) % 3])
    return abs(_twice(p)) / 2 if len(p) >= 3 else Fraction(0)


def _twice(p):
    return sum(p[i][0] * p[(i + 1) % len(p)][1] - p[i][1] * p[(i + 1) % len(p)][0] for i in range(len(p)))


def overlaps(*reads, apart=None, among=None):
    """Pairs of triangles of any of the objects that have an area in common, as pairs of (object, polygon).

    apart : labels of the polygons of one object, such as their islands; pairs with one label are not looked at
    among : marks of the polygons of one object that are looked at
    """
    t = np.concatenate([r.tri() for r in reads])
    of = np.array([(k, int(p)) for k, r in enumerate(reads) for p in r.of])
    label = np.arange(len(of)) if apart is None else np.asarray(apart)[of[:, 1]]
    low, high = t.min(1), t.max(1)
    order = np.argsort(low[:, 0])
    if among is not None:
        order = order[among[of[order, 1]]]
    sorted_low = low[order, 0]
    found = set()
    for at, i in enumerate(order):
        near = order[at + 1 : np.searchsorted(sorted_low, high[i, 0])]
        near = near[(low[near, 1] < high[i, 1]) & (low[i, 1] < high[near, 1]) & (label[near] != label[i])]
        near = near[(of[near] != of[i]).any(1)]
        for j in near[~_parted(t[i], t[near])]:
            if common_area(t[i], t[j]) > 0:
                found.add(tuple(sorted((tuple(of[i].tolist()), tuple(of[j].tolist())))))
    return found


def _parted(p, others):
    """Of which triangles a side surely has p beyond it, or they are beyond one of p: most, so that few are clipped."""
    parted = np.zeros(len(others), bool)
    p = np.broadcast_to(p, others.shape)
    for a, b in ((p, others), (others, p)):
        way = np.where(_areas(a) > 0, 1, -1)[:, None]
        for k in range(3):
            d = (a[:, (k + 1) % 3] - a[:, k])[:, None]
            e = b - a[:, k][:, None]
            parted |= (way * (d[..., 0] * e[..., 1] - d[..., 1] * e[..., 0]) < -1e-12).all(1)
    return parted


def energy(r, triangles=None):
    """Area mean of |S|^2 (1 + 1 / det^2) of all or some triangles at their scale; infinite where one is flipped."""
    F = r.vertex[r.triangles]
    e1, e2 = r.V[F[:, 1]] - r.V[F[:, 0]], r.V[F[:, 2]] - r.V[F[:, 0]]
    area = np.linalg.norm(np.cross(e1, e2), axis=1) / 2
    t = r.tri()
    flat = _areas(t)
    flat = flat * np.sign(flat.sum())
    some = np.ones(len(area), bool) if triangles is None else triangles
    scale2 = area[some].sum() / np.abs(flat[some]).sum()
    length = np.linalg.norm(e1, axis=1)
    x2, y2 = (e1 * e2).sum(1) / length, 2 * area / length
    g1, g2 = t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]
    S1 = g1 / length[:, None]
    S2 = (g2 - S1 * x2[:, None]) / y2[:, None]
    J = flat / area * scale2
    E = ((S1**2).sum(1) + (S2**2).sum(1)) * scale2 * (1 + 1 / J**2)
    E[J <= 0] = np.inf
    return float((E * area)[some].sum() / area[some].sum())


def densities(r):
    """Lengths in the plane by lengths in space of each island."""
    part = islands(r)[r.of]
    F = r.vertex[r.triangles]
    area = np.linalg.norm(np.cross(r.V[F[:, 1]] - r.V[F[:, 0]], r.V[F[:, 2]] - r.V[F[:, 0]]), axis=1) / 2
    flat = np.abs(_areas(r.tri()))
    return np.array([np.sqrt(flat[part == k].sum() / area[part == k].sum()) for k in np.unique(part)])
