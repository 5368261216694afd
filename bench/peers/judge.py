# SPDX-License-Identifier: MIT
"""Judges texture coordinates by corners, with numpy alone."""

import numpy as np


def read_off(path):
    """Vertices and triangles of a text OFF file; polygons become fans."""
    words = []
    for line in open(path, encoding="utf-8", errors="replace"):
        words += line.split("#")[0].split()
    if words[0].upper().endswith("OFF"):
        words = words[1:]
    n, m = int(words[0]), int(words[1])
    V = np.array(words[3:3 + 3 * n], dtype=float).reshape(n, 3)
    faces, at = [], 3 + 3 * n
    for _ in range(m):
        k = int(words[at])
        f = [int(w) for w in words[at + 1:at + 1 + k]]
        faces += [[f[0], f[i], f[i + 1]] for i in range(1, k - 1)]
        at += 1 + k
    return V, np.array(faces)


def read_obj(path):
    """Coordinates by corner, vertices and triangles of a Wavefront file with texture coordinates; polygons become fans."""
    V, t, F, T = [], [], [], []
    for line in open(path, encoding="utf-8", errors="replace"):
        words = line.split()
        if words[:1] == ["v"]:
            V.append([float(w) for w in words[1:4]])
        elif words[:1] == ["vt"]:
            t.append([float(w) for w in words[1:3]])
        elif words[:1] == ["f"]:
            corners = [[int(w) for w in c.split("/")[:2]] for c in words[1:]]
            for i in range(1, len(corners) - 1):
                F.append([corners[k][0] - 1 for k in (0, i, i + 1)])
                T.append([corners[k][1] - 1 for k in (0, i, i + 1)])
    return np.array(t)[np.array(T)], np.array(V), np.array(F)


def load(path):
    """Vertices and triangles that a peer leaves, mostly those that it got, and coordinates by corner, (m, 3, 2)."""
    made = np.load(path)
    V, F = made["V"].astype(float), made["F"].astype(int)
    # Vertices that were parted at seams are one again: those at one place.
    place = np.unique(V, axis=0, return_inverse=True)[1].reshape(-1)
    first = np.full(place.max() + 1, len(V))
    np.minimum.at(first, place, np.arange(len(V)))
    return V, first[place][F], made["corner_uv"].astype(float)


def edges(F):
    """Pairs of sides that are one edge: (cell, side) numbers 3 * cell + side, of edges with two cells."""
    ends = np.stack([F, np.roll(F, -1, 1)], 2).reshape(-1, 2)
    key = np.sort(ends, 1)
    order = np.lexsort((key[:, 1], key[:, 0]))
    same = (key[order[1:]] == key[order[:-1]]).all(1)
    pairs = np.c_[order[:-1][same], order[1:][same]]
    return pairs, ends


def roots(n, pairs):
    """The smallest number of the part that each of n things is of."""
    label = np.arange(n)
    while True:
        low = np.minimum(label[pairs[:, 0]], label[pairs[:, 1]])
        new = label.copy()
        np.minimum.at(new, pairs[:, 0], low)
        np.minimum.at(new, pairs[:, 1], low)
        new = new[new]
        if (new == label).all():
            return label
        label = new


def doubly_covered(uv, texels=2048):
    """The part of what is covered that two triangles or more cover: of the centres of texels strictly inside of them."""
    low = uv.reshape(-1, 2).min(0)
    size = max((uv.reshape(-1, 2).max(0) - low).max(), 1e-300)
    count = np.zeros((texels, texels), dtype=np.uint16)
    t = (uv - low) / size * texels
    for a, b, c in t:
        if (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) < 0:
            b, c = c, b
        x0, y0 = np.floor(np.minimum(np.minimum(a, b), c)).astype(int)
        x1, y1 = np.ceil(np.maximum(np.maximum(a, b), c)).astype(int)
        x, y = np.meshgrid(np.arange(max(x0, 0), min(x1, texels)) + 0.5, np.arange(max(y0, 0), min(y1, texels)) + 0.5)
        inside = np.ones(x.shape, dtype=bool)
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) > 1e-9
        count[max(y0, 0):min(y1, texels), max(x0, 0):min(x1, texels)][inside] += 1
    return float((count > 1).sum() / max((count > 0).sum(), 1))


def judge(V, F, uv):
    """Charts, seams, distortion, flips and overlaps of texture coordinates by corners."""
    if uv.shape != (len(F), 3, 2):
        return {"error": f"coordinates of {len(uv)} triangles, not {len(F)}"}
    e1, e2 = V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]
    area = np.linalg.norm(np.cross(e1, e2), axis=1) / 2
    g1, g2 = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    det = g1[:, 0] * g2[:, 1] - g1[:, 1] * g2[:, 0]
    finite = np.isfinite(uv).all((1, 2))
    solid = area > 0
    pairs, ends = edges(F)
    a, b = pairs[:, 0], pairs[:, 1]
    corner = uv.reshape(-1, 2)
    after = lambda s: s // 3 * 3 + (s + 1) % 3
    opposite = (ends[a] == ends[b][:, ::-1]).all(1)
    first, second = np.where(opposite, after(b), b), np.where(opposite, b, after(b))
    size = np.ptp(corner[np.isfinite(corner).all(1)], axis=0).max()
    joined = (np.abs(corner[a] - corner[first]).max(1) <= 1e-6 * size) & (
        np.abs(corner[after(a)] - corner[second]).max(1) <= 1e-6 * size)
    seam = np.linalg.norm(V[ends[a, 0]] - V[ends[a, 1]], axis=1)[~joined].sum()
    chart = np.unique(roots(len(F), np.c_[a[joined] // 3, b[joined] // 3]), return_inverse=True)[1].reshape(-1)
    charts = int(chart.max()) + 1

    # A chart that is mirrored as a whole is no fold: triangles are held against the most of their chart.
    mirrored = np.bincount(chart, np.where(finite, np.sign(det) * area, 0.0)) < 0
    det = np.where(mirrored[chart], -det, det)
    flips = int(((det <= 0) | ~finite)[solid].sum())

    # E = |S|^2 (1 + 1 / det^2) at the scale at which areas agree.
    scale2 = area.sum() / (np.abs(det[finite]).sum() / 2)
    length = np.linalg.norm(e1, axis=1)
    with np.errstate(all="ignore"):
        x2 = (e1 * e2).sum(1) / length
        y2 = 2 * area / length
        S1 = g1 / length[:, None]
        S2 = (g2 - S1 * x2[:, None]) / y2[:, None]
        norm2 = ((S1**2).sum(1) + (S2**2).sum(1)) * scale2
        J = det / (2 * area) * scale2
        E = norm2 * (1 + 1 / J**2)
    good = solid & finite & (det > 0) & np.isfinite(E)
    mean = float((E * area)[good].sum() / area[good].sum()) if good.any() else float("inf")

    used = np.abs(det[finite]).sum() / 2
    box = np.ptp(corner[np.isfinite(corner).all(1)], axis=0)
    return {"charts": charts, "seam": float(seam / np.sqrt(area.sum())), "energy": mean, "flips": flips,
            "mirrored": int(mirrored.sum()),
            "overlap": doubly_covered(uv[finite & solid]), "use": float(used / max(box.max() ** 2, 1e-300))}
