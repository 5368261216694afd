# SPDX-License-Identifier: MIT
"""Meshes in pieces, as VTK and OpenFOAM write them, and meshes of other cells, for tests."""
import os
import struct

VTK = {4: 10, 5: 14, 6: 13, 8: 12}
# Sides of cells in VTK's numbers, normals pointing out.
SIDES = {
    4: [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)],
    5: [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
    6: [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
    8: [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
}


def mixed_bar(n):
    """A bar of 1 x 1 x 4: hexahedra below, then wedges, then pyramids about a middle point. Points, cells."""
    points, cells = [], []
    for k in range(4 * n + 1):
        for j in range(n + 1):
            for i in range(n + 1):
                s = 0.1 / n if 0 < i < n and 0 < j < n and 0 < k < 4 * n else 0
                points.append([i / n + s, j / n - s, k / n + s / 2])

    def at(i, j, k):
        return (k * (n + 1) + j) * (n + 1) + i

    for k in range(4 * n):
        for j in range(n):
            for i in range(n):
                h = [at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k)]
                h += [at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)]
                if k < 2 * n:
                    cells.append(h)
                elif k < 3 * n:
                    cells.append([h[0], h[2], h[1], h[4], h[6], h[5]])
                    cells.append([h[0], h[3], h[2], h[4], h[7], h[6]])
                else:
                    middle = len(points)
                    points.append([sum(points[v][c] for v in h) / 8 for c in range(3)])
                    for side in SIDES[8]:
                        cells.append([h[v] for v in reversed(side)] + [middle])
    return points, cells


def parts(points, cells, count):
    """Cells in blocks, each with its own points: lists of (numbers of the points, cells in numbers of their own)."""
    result = []
    for p in range(count):
        own = cells[len(cells) * p // count:len(cells) * (p + 1) // count]
        numbers = sorted({v for c in own for v in c})
        place = {v: k for k, v in enumerate(numbers)}
        result.append((numbers, [[place[v] for v in c] for c in own]))
    return result


def vtu(path, points, cells, global_ids=None, real="Float64", regions=None, ghost=()):
    with open(path, "w") as f:
        f.write('<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>\n')
        f.write(f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">\n')
        if global_ids is not None:
            f.write('<PointData GlobalIds="ids"><DataArray type="Int64" Name="ids" format="ascii">\n')
            f.writelines(f"{v}\n" for v in global_ids)
            f.write("</DataArray></PointData>\n")
        f.write("<CellData>\n")
        if regions is not None:
            f.write('<DataArray type="Int32" Name="region" format="ascii">\n')
            f.writelines(f"{r}\n" for r in regions)
            f.write("</DataArray>\n")
        if ghost:
            f.write('<DataArray type="UInt8" Name="vtkGhostType" format="ascii">\n')
            f.writelines(f"{int(c in ghost)}\n" for c in range(len(cells)))
            f.write("</DataArray>\n")
        f.write(f'</CellData>\n<Points><DataArray type="{real}" NumberOfComponents="3" format="ascii">\n')
        f.writelines("%.17g %.17g %.17g\n" % tuple(p) for p in points)
        f.write('</DataArray></Points><Cells><DataArray type="Int32" Name="connectivity" format="ascii">\n')
        f.writelines(" ".join(map(str, c)) + "\n" for c in cells)
        f.write('</DataArray><DataArray type="Int32" Name="offsets" format="ascii">\n')
        end = 0
        for c in cells:
            end += len(c)
            f.write(f"{end}\n")
        f.write('</DataArray><DataArray type="UInt8" Name="types" format="ascii">\n')
        f.writelines(f"{VTK[len(c)]}\n" for c in cells)
        f.write("</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n")


def pvtu(path, points, cells, count, global_ids=True, empty=False):
    """Of two regions, halves of the cells; with a layer of ghosts in the first piece. Returns the numbers of points."""
    name = os.path.splitext(path)[0]
    os.makedirs(name, exist_ok=True)
    numbers = []
    first = 0
    for k, (own, local) in enumerate(parts(points, cells, count)):
        regions = [int(2 * (first + c) >= len(cells)) for c in range(len(local))]
        first += len(local)
        ghost = []
        if k == 0 and count > 1:  # the next cell of another piece
            more = cells[len(local)]
            for v in more:
                if v not in own:
                    own.append(v)
            local = local + [[own.index(v) for v in more]]
            regions.append(0)
            ghost = [len(local) - 1]
        numbers.append(own)
        vtu(f"{name}/piece_{k}.vtu", [points[v] for v in own], local, [3 * v + 7 for v in own] if global_ids else None,
            regions=regions, ghost=ghost)
    with open(path, "w") as f:
        f.write('<?xml version="1.0"?>\n<VTKFile type="PUnstructuredGrid"><PUnstructuredGrid GhostLevel="1">\n')
        f.writelines(f'<Piece Source="{name}/piece_{k}.vtu"/>\n' for k in range(count))
        if empty:
            f.write(f'<Piece Source="{name}/none.vtu"/>\n')
            vtu(f"{name}/none.vtu", [], [], [] if global_ids else None)
        f.write("</PUnstructuredGrid></VTKFile>\n")
    return numbers


def points_of_vtu(path):
    with open(path) as f:
        text = f.read()
    begin = text.index('NumberOfComponents="3" format="ascii">') + 38
    rest = text[begin:text.index("</DataArray>", begin)]
    return [tuple(map(float, line.split())) for line in rest.strip().split("\n")]


class foam:
    """The folder polyMesh of cells, in binary or as text."""

    def __init__(self, folder, points, cells, patch_of, numbers=None, binary=False):
        os.makedirs(folder)
        self.folder, self.binary = folder, binary
        sides = {}
        for c, cell in enumerate(cells):
            for side in SIDES[len(cell)]:
                around = [cell[v] for v in side]
                sides.setdefault(tuple(sorted(around)), []).append((c, around))
        inner = sorted((s for s in sides.values() if len(s) == 2), key=lambda s: (s[0][0], s[1][0]))
        patches = {}
        for s in sides.values():
            if len(s) == 1:
                patches.setdefault(patch_of(s[0][1]), []).append(s[0])
        faces, owner, starts = [s[0][1] for s in inner], [s[0][0] for s in inner], {}
        for name in sorted(patches):
            starts[name] = len(faces)
            faces += [around for _, around in patches[name]]
            owner += [c for c, _ in patches[name]]
        if binary:
            self.write("points", "vectorField", len(points), b"".join(struct.pack("<3d", *p) for p in points))
            ends = [0]
            for around in faces:
                ends.append(ends[-1] + len(around))
            self.write("faces", "faceCompactList", len(ends), self.labels(ends),
                       b"\n%d\n(" % ends[-1] + self.labels([v for around in faces for v in around]) + b")")
        else:
            self.write("points", "vectorField", len(points), "".join("\n(%.17g %.17g %.17g)" % tuple(p) for p in points))
            self.write("faces", "faceList", len(faces),
                       "".join(f"\n{len(around)}({' '.join(map(str, around))})" for around in faces))
        self.write("owner", "labelList", len(owner), self.labels(owner))
        self.write("neighbour", "labelList", len(inner), self.labels([s[1][0] for s in inner]))
        if numbers is not None:
            self.write("pointProcAddressing", "labelList", len(numbers), self.labels(numbers))
        with open(f"{folder}/boundary", "w") as f:
            f.write(self.head("polyBoundaryMesh") + f"{len(patches)}\n(\n")
            for name in sorted(patches):
                kind = "processor" if name.startswith("proc") else "patch"
                f.write(f"    {name}\n    {{\n        type {kind};\n        inGroups 1(all);\n"
                        f"        nFaces {len(patches[name])};\n        startFace {starts[name]};\n    }}\n")
            f.write(")\n\n// ***** //\n")

    def labels(self, numbers):
        if self.binary:
            return struct.pack(f"<{len(numbers)}i", *numbers)
        return "\n" + "\n".join(map(str, numbers)) + "\n"

    def head(self, kind):
        return ('/*--- C++ ---*\\\n  =====\n\\*---*/\nFoamFile\n{\n    version 2.0;\n    format '
                + ("binary" if self.binary else "ascii")
                + f';\n    arch "LSB;label=32;scalar=64";\n    class {kind};\n    location "constant/polyMesh";\n'
                + "    object x; // a name\n}\n// * * * //\n\n\n")

    def write(self, name, kind, count, items, more=b""):
        with open(f"{self.folder}/{name}", "wb") as f:
            f.write((self.head(kind) + f"{count}\n(").encode())
            f.write(items if self.binary else items.encode())
            f.write(b")" + more + b"\n\n// ***** //\n")


def foam_zones(folder, kind, zones, binary):
    """A file of zones, as OpenFOAM writes it: items of each by name; of faces with their orientations, too."""
    def items(numbers):
        return struct.pack(f"<{len(numbers)}i", *numbers) if binary else " ".join(map(str, numbers)).encode()

    with open(f"{folder}/{kind}Zones", "wb") as f:
        f.write(b"FoamFile\n{\n    version 2.0;\n    format " + (b"binary" if binary else b"ascii")
                + b';\n    arch "LSB;label=32;scalar=64";\n    class regIOobject;\n}\n\n%d\n(\n' % len(zones))
        for name, numbers in zones.items():
            f.write(f"{name}\n{{\n    type {kind}Zone;\n    {kind}Labels List<label> \n{len(numbers)}\n".encode())
            f.write(b"(" + items(numbers) + b");\n" if numbers or not binary else b";\n")
            if kind == "face":
                flags = b"(" + b"\0" * len(numbers) + b")" if binary and numbers else b"" if binary else b"{0}"
                f.write(b"    flipMap List<bool> %d" % len(numbers) + flags + b";\n")
            f.write(b"}\n")
        f.write(b")\n")


def foam_case(folder, points, cells, count, patch_of, binary=False, numbers=True):
    """A decomposed case. patch_of(points of a face): the patch, or None for a face between pieces or none."""
    outside = {}
    for cell in cells:
        for side in SIDES[len(cell)]:
            key = tuple(sorted(cell[v] for v in side))
            outside[key] = outside.get(key, 0) + 1
    pieces = []
    for k, (own, local) in enumerate(parts(points, cells, count)):
        def name(around, own=own):
            if outside[tuple(sorted(own[v] for v in around))] == 2:
                return "procBoundary"
            return patch_of([points[own[v]] for v in around])

        foam(f"{folder}/processor{k}/constant/polyMesh", [points[v] for v in own], local, name,
             own if numbers else None, binary)
        pieces.append(own)
    return pieces


def points_of_foam(folder):
    with open(folder + "/points", "rb") as f:
        data = f.read()
    begin = data.index(b"* * * //") + 8
    n = int(data[begin:data.index(b"(", begin)])
    at = data.index(b"(", begin) + 1
    if b"format binary" in data:
        return [struct.unpack_from("<3d", data, at + 24 * v) for v in range(n)]
    return [tuple(map(float, line.strip("()").split())) for line in data[at:].decode().split("\n")[1:n + 1]]
