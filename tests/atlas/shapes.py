# SPDX-License-Identifier: MIT
"""Closed surfaces for the tests of atlases."""


def cube(n, place):
    """Points and triangles of a cube with n^2 squares a side; place: the point of three whole numbers from 0 to n."""
    points, triangles, number = [], [], {}

    def vertex(p):
        if p not in number:
            number[p] = len(points)
            points.append(place(p))
        return number[p]

    for axis in range(3):
        for side in (0, n):
            for i in range(n):
                for j in range(n):
                    def at(a, b):
                        p = [0, 0, 0]
                        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, a, b
                        return vertex(tuple(p))
                    q = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
                    q = q if side else q[::-1]
                    triangles += [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]
    return points, triangles
