# SPDX-License-Identifier: MIT
"""Exact geometry on rational numbers: the judge of what the program writes."""
from fractions import Fraction


def exact(point):
    """A point in rational coordinates. Floats stand for themselves, text for the double that is nearest."""
    return tuple(Fraction(float(x)) for x in point)


def sign(x):
    return (x > 0) - (x < 0)


def area2(a, b, c):
    """Twice the signed area of a triangle of the plane."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def volume6(a, b, c, d):
    """Six times the signed volume of a tetrahedron, positive where d lies above a, b, c counter-clockwise."""
    u, v, w = ([q - p for p, q in zip(a, x)] for x in (b, c, d))
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0])
            + u[2] * (v[0] * w[1] - v[1] * w[0]))


def polygon_area2(points):
    """Twice the signed area of a polygon of the plane."""
    return sum(p[0] * q[1] - p[1] * q[0] for p, q in zip(points, points[1:] + points[:1]))


def segments_cross(a, b, c, d):
    """Whether the insides of two segments of the plane have a point in common."""
    return (sign(area2(a, b, c)) * sign(area2(a, b, d)) < 0
            and sign(area2(c, d, a)) * sign(area2(c, d, b)) < 0)


def triangles_overlap(s, t):
    """Whether the insides of two counter-clockwise triangles of the plane have a point in common."""
    for p, q in ((s, t), (t, s)):
        for k in range(3):
            if all(area2(p[k], p[(k + 1) % 3], x) <= 0 for x in q):
                return False
    return True


def overlaps(triangles):
    """Pairs of triangles of the plane, of any orientation, whose insides have a point in common."""
    turned = [t if area2(*t) > 0 else (t[0], t[2], t[1]) for t in triangles]
    boxes = [(min(p[0] for p in t), max(p[0] for p in t), min(p[1] for p in t), max(p[1] for p in t))
             for t in turned]
    order = sorted((i for i, t in enumerate(turned) if area2(*t) > 0), key=lambda i: boxes[i][0])
    pairs, active = [], []
    for i in order:
        x0, _, y0, y1 = boxes[i]
        active = [j for j in active if boxes[j][1] > x0]
        pairs += [(j, i) for j in active if boxes[j][2] < y1 and boxes[j][3] > y0
                  and triangles_overlap(turned[i], turned[j])]
        active.append(i)
    return pairs
