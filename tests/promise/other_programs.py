# SPDX-License-Identifier: MIT
"""other_programs.py PROGRAM FOLDER [CASE...]
Round trips with other programs: meshio, VTK, gmsh, trimesh and pygltflib write files in each of their ways, the program moves
points or gives texture coordinates, and they read both. All that they see but coordinates must be as it was.

A program that is not there is left out: code 77 where that leaves nothing. They are looked for in this Python, in build/readers
(scripts/setup --with-readers) and in /usr/bin/python3, where Debian's python3-meshio is."""
import contextlib
import itertools
import json
import os

from foreign import blocks_of, go_to_python, GRID, mixed, needs, np, patch, plane, round_trip, same, su2, tetrahedra
from program import main


def meshio(taut):
    """What meshio writes and reads."""
    needs("meshio")
    import meshio as io
    turned = {"wedge": (0, 2, 1, 3, 5, 4)}  # meshio hands on what a file has: MEDIT and gmsh have wedges the other way around

    def contents(path):
        with open(os.devnull, "w") as nothing, contextlib.redirect_stdout(nothing), contextlib.redirect_stderr(nothing):
            m = io.read(path)
        points = np.zeros((len(m.points), 3))
        points[:, :m.points.shape[1]] = m.points
        rest = {"type": m.points.dtype, "columns": m.points.shape[1], "cells": [(b.type, b.data) for b in m.cells]}
        for name in ("point_data", "cell_data", "field_data", "point_sets", "cell_sets"):
            table = getattr(m, name)
            rest[name] = {k: [np.asarray(x) for x in table[k]] for k in sorted(table)}
        return points, rest

    def write(name, mesh, tags=(), order={}, data={}, real=float, names=None, kinds=None, columns=3, more={}, **options):
        points, cells = mesh
        blocks = blocks_of([c for c in cells if not kinds or c[0] in kinds], order)
        m = io.Mesh(np.array(points, real)[:, :columns], [(k, c) for k, c, _ in blocks], field_data=names or {},
                    cell_data={**{t: [l for _, _, l in blocks] for t in tags}, **more}, point_data=data)
        with open(os.devnull, "w") as nothing, contextlib.redirect_stdout(nothing), contextlib.redirect_stderr(nothing):
            io.write(taut.file(name), m, **options)
        round_trip(taut, name, contents)

    for shape, mesh in (("tets", tetrahedra()), ("mixed", mixed())):
        n = len(mesh[0])
        write(f"{shape}.mesh", mesh, ["medit:ref"], turned, {"medit:ref": np.arange(n) % 4})
        data = {"vectors": np.arange(3. * n).reshape(n, 3) / 7, "side": np.arange(n) % 2}
        for binary in (False, True):
            kind = "binary" if binary else "text"
            write(f"{shape}-22-{kind}.msh", mesh, ["gmsh:physical", "gmsh:geometrical"], turned,
                  names={"body": np.array([1, 3]), "the bottom": np.array([5, 2])}, file_format="gmsh22", binary=binary)
            if shape == "tets":  # of version 4.1 meshio reads no more than one entity
                write(f"{shape}-41-{kind}.msh", (mesh[0], [c[:2] + (1,) for c in mesh[1] if c[0] == "tetra"]), ["gmsh:physical", "gmsh:geometrical"],
                      data={"gmsh:dim_tags": np.array([[3, 1]] * n)}, names={"body": np.array([1, 3])}, file_format="gmsh", binary=binary)
            write(f"{shape}-{kind}.vtk", mesh, ["part"], {}, data, np.float32 if binary else float, file_format="vtk", binary=binary)
        for code, options in (("text", {"binary": False}), ("none", {"compression": None}), ("zlib", {"compression": "zlib"}),
                              ("lzma", {"compression": "lzma", "header_type": "UInt64"})):
            write(f"{shape}-{code}.vtu", mesh, ["part"], {}, data, **options)
        taut.write(f"{shape}.su2", su2(*mesh))
        round_trip(taut, f"{shape}.su2", contents)
    write("tets.node", tetrahedra(), ["tetgen:ref"], kinds=["tetra"])
    write("plane.mesh", plane(), ["medit:ref"], columns=2)
    sides = [("line", (v, v + 4), 3) for v in (0, 4, 8)] + [("line", (v + 4, v), 4) for v in (3, 7, 11)]
    taut.write("plane.su2", su2(plane()[0], sides + plane()[1], 2))
    round_trip(taut, "plane.su2", contents)
    write("plane.vtu", plane(), ["part"])

    points, faces = patch()
    for name, options in (("in.obj", {}), ("in.off", {}), ("text.ply", {"binary": False}), ("binary.ply", {"binary": True}),
                          ("text.stl", {"binary": False}), ("binary.stl", {"binary": True})):
        with open(os.devnull, "w") as nothing, contextlib.redirect_stdout(nothing), contextlib.redirect_stderr(nothing):
            io.write(taut.file(name), io.Mesh(np.array(points), [("triangle", np.array(faces))]), **options)
            m = io.read(taut.file(name))
        taut("unwrap", name, "-o", "out.obj")
        out = io.read(taut.file("out.obj"))
        a, b = (x.points[np.concatenate([c.data for c in x.cells if c.type == "triangle"])].astype(np.float32) for x in (m, out))
        same(a, b, f"{name}: triangles")


def vtk(taut):
    """What VTK writes and reads: all encodings, text and binary, and surfaces."""
    needs("vtkmodules")
    from vtkmodules import vtkCommonCore as core, vtkCommonDataModel as model, vtkIOGeometry, vtkIOLegacy, vtkIOPLY, vtkIOXML
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

    def array(name, values):
        a = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        a.SetName(name)
        return a

    def values(a):
        told = (a.GetName(), a.GetClassName(), a.GetNumberOfComponents(), [a.GetComponentName(k) for k in range(a.GetNumberOfComponents())])
        return told, vtk_to_numpy(a) if isinstance(a, core.vtkDataArray) else [a.GetValue(k) for k in range(a.GetNumberOfValues())]

    def data_of(data):
        return {"arrays": [values(data.GetAbstractArray(i)) for i in range(data.GetNumberOfArrays())],
                "active": [getattr(data, f"Get{x}")() and getattr(data, f"Get{x}")().GetName() for x in
                           ("Scalars", "Vectors", "Normals", "TCoords", "GlobalIds") if hasattr(data, f"Get{x}")]}

    def contents(path):
        reader = vtkIOXML.vtkXMLUnstructuredGridReader() if path.endswith(".vtu") else vtkIOLegacy.vtkUnstructuredGridReader()
        for what in ("Scalars", "Vectors", "Normals", "Tensors", "ColorScalars", "TCoords", "Fields"):
            if not path.endswith(".vtu"):
                getattr(reader, f"ReadAll{what}On")()
        reader.SetFileName(path)
        reader.Update()
        grid = reader.GetOutput()
        assert grid.GetNumberOfCells() > 0, f"VTK cannot read {path}"
        points = vtk_to_numpy(grid.GetPoints().GetData())
        return points.astype(float), {
            "type": points.dtype, "types": [grid.GetCellType(c) for c in range(grid.GetNumberOfCells())],
            "corners": [[grid.GetCell(c).GetPointId(k) for k in range(grid.GetCell(c).GetNumberOfPoints())] for c in range(grid.GetNumberOfCells())],
            "points": data_of(grid.GetPointData()), "cells": data_of(grid.GetCellData()), "fields": data_of(grid.GetFieldData())}

    def grid_of(mesh, real):
        types = {"triangle": 5, "quad": 9, "tetra": 10, "pyramid": 14, "wedge": 13, "hexahedron": 12, "voxel": 11, "line": 3, "vertex": 1}
        places, cells = mesh
        points, grid, n = core.vtkPoints(), model.vtkUnstructuredGrid(), len(places)
        points.SetData(array("Points", np.array(places, real)))
        grid.SetPoints(points)
        for kind, corners, _ in [*cells, ("line", (0, 1), 8), ("vertex", (2,), 9)]:
            ids = core.vtkIdList()
            for v in corners:
                ids.InsertNextId(v)
            grid.InsertNextCell(types[kind], ids)
        vectors, names = array("velocity of it", np.arange(3 * n, dtype=np.float32).reshape(n, 3) / 7), core.vtkStringArray()
        vectors.SetComponentName(0, "along")
        grid.GetPointData().SetVectors(vectors)
        for a in (array("side", np.arange(n, dtype=np.int16) % 2), array("tensor", np.arange(9. * n).reshape(n, 9))):
            grid.GetPointData().AddArray(a)
        grid.GetCellData().SetScalars(array("part", np.array([c[2] for c in cells] + [8, 9], np.int32)))
        grid.GetCellData().AddArray(array("quality", np.arange(len(cells) + 2, dtype=float) / 3))
        names.SetName("names")
        for word in ("one", "two words", "ü <&>"):
            names.InsertNextValue(word)
        grid.GetFieldData().AddArray(names)
        grid.GetFieldData().AddArray(array("TimeValue", np.array([0.1])))
        return grid

    def voxels():
        cells = [("voxel", tuple(GRID.index((x + i, y + j, z + k)) for k in (0, 1) for j in (0, 1) for i in (0, 1)), 1 + x)
                 for x, y, z in itertools.product(range(2), repeat=3)]
        return [p if p != (1, 1, 1) else (1.25, 1, 1.25) for p in GRID], cells

    for shape, mesh in (("mixed", mixed()), ("voxels", voxels()), ("tets", tetrahedra())):
        for real in (np.float64, np.float32):
            grid = grid_of(mesh, real)
            for version, text in itertools.product((42, 51), (True, False)):
                writer = vtkIOLegacy.vtkUnstructuredGridWriter()
                writer.SetFileVersion(version)
                (writer.SetFileTypeToASCII if text else writer.SetFileTypeToBinary)()
                name = f"{shape}-{version}-{'text' if text else 'binary'}-{np.dtype(real).name}.vtk"
                writer.SetFileName(taut.file(name)), writer.SetInputData(grid), writer.Write()
                round_trip(taut, name, contents, ["deform", "smooth"] if shape == "mixed" else ["deform"])
    ways = [("Ascii", None, None)] + [("Binary", None, c) for c in ("None", "ZLib", "LZ4", "LZMA")]
    ways += [("Appended", base, c) for base in (0, 1) for c in ("None", "ZLib", "LZ4", "LZMA")]
    for k, (mode, base, compressor) in enumerate(ways):
        for header, order in ((32, "LittleEndian"), (64, "BigEndian")):
            writer = vtkIOXML.vtkXMLUnstructuredGridWriter()
            getattr(writer, f"SetDataModeTo{mode}")(), getattr(writer, f"SetByteOrderTo{order}")()
            getattr(writer, f"SetHeaderTypeToUInt{header}")(), getattr(writer, f"SetCompressorTypeTo{compressor}")()
            if base is not None:
                writer.SetEncodeAppendedData(base)
            if k % 2:
                writer.SetBlockSize(240)
            name = f"{mode}-{base}-{compressor}-{header}.vtu"
            writer.SetFileName(taut.file(name)), writer.SetInputData(grid_of(mixed(), np.float32 if k % 3 == 0 else np.float64)), writer.Write()
            round_trip(taut, name, contents, ["deform", "smooth"] if k < 3 else ["deform"])

    points, faces = patch()
    surface, cells = model.vtkPolyData(), model.vtkCellArray()
    at = core.vtkPoints()
    at.SetData(array("Points", np.array(points, np.float32)))
    for f in faces:
        cells.InsertNextCell(3, f)
    surface.SetPoints(at), surface.SetPolys(cells)
    surface.GetPointData().SetNormals(array("Normals", np.array([(0, 0.6, 0.8)] * len(points), np.float32)))

    def triangles(reader, path):
        reader.SetFileName(path)
        reader.Update()
        out = reader.GetOutput()
        corners = [[out.GetCell(c).GetPointId(k) for k in range(out.GetCell(c).GetNumberOfPoints())] for c in range(out.GetNumberOfPolys())]
        at, normals = vtk_to_numpy(out.GetPoints().GetData()), out.GetPointData().GetNormals()
        assert not path.endswith("out.obj") or out.GetPointData().GetTCoords(), "no texture coordinates"
        return at[np.array(corners)].astype(np.float32), vtk_to_numpy(normals)[np.array(corners)].astype(np.float32) if normals else []
    for name, writer, reader in (("in.obj", vtkIOGeometry.vtkOBJWriter, vtkIOGeometry.vtkOBJReader), ("in.ply", vtkIOPLY.vtkPLYWriter, vtkIOPLY.vtkPLYReader),
                                 ("text.ply", vtkIOPLY.vtkPLYWriter, vtkIOPLY.vtkPLYReader), ("in.stl", vtkIOGeometry.vtkSTLWriter, vtkIOGeometry.vtkSTLReader)):
        w = writer()
        w.SetFileName(taut.file(name)), w.SetInputData(surface)
        if name == "text.ply":
            w.SetFileTypeToASCII()
        w.Write()
        before = triangles(reader(), taut.file(name))
        for command in ("unwrap", "atlas"):
            taut(command, name, "-o", "out.obj")
            same(before, triangles(vtkIOGeometry.vtkOBJReader(), taut.file("out.obj")), f"{command} {name}")


def gmsh(taut):
    """What gmsh writes and reads: entities, physical groups, parameters."""
    needs("gmsh")
    import gmsh as g

    def contents(path):
        g.clear()
        g.open(path)
        tags, x, _ = g.model.mesh.getNodes()
        order = np.argsort(tags)
        entities = g.model.getEntities()
        rest = {"tags": tags[order], "entities": entities,
                "nodes": [[g.model.mesh.getNodes(*e, False, True)[k] for k in (0, 2)] for e in entities],
                "elements": [g.model.mesh.getElements(*e) for e in entities],
                "groups": [(e, g.model.getPhysicalName(*e), g.model.getEntitiesForPhysicalGroup(*e)) for e in g.model.getPhysicalGroups()]}
        return x.reshape(-1, 3)[order], rest

    def build(cells):
        g.clear()
        occ = g.model.occ
        a = occ.addBox(0, 0, 0, 1, 1, 1) if cells == "tets" else occ.addRectangle(0, 0, 0, 1, 1)
        b = occ.addBox(1, 0, 0, 1, 1, 1) if cells == "tets" else occ.addRectangle(1, 0, 0, 1, 1)
        dimension = 3 if cells == "tets" else 2
        occ.fragment([(dimension, a)], [(dimension, b)])
        if cells in ("wedges", "hexahedra"):
            occ.extrude(occ.getEntities(2), 0, 0, 1, numElements=[2], recombine=True)
        occ.synchronize()
        dimension = 2 if cells == "plane" else 3
        solids = [tag for _, tag in g.model.getEntities(dimension)]
        for k, tag in enumerate(solids):
            g.model.addPhysicalGroup(dimension, [tag], 10 + k, name=f"part {k}")
        sides = [tag for _, tag in g.model.getEntities(dimension - 1)]
        g.model.addPhysicalGroup(dimension - 1, sides[:2], 20, name="ends"), g.model.addPhysicalGroup(dimension - 1, sides[2:], 21, name="others")
        g.option.setNumber("Mesh.RecombineAll", int(cells == "hexahedra"))
        g.option.setNumber("Mesh.MeshSizeMin", 0.5), g.option.setNumber("Mesh.MeshSizeMax", 0.5)
        if cells == "hexahedra":
            for _, tag in g.model.getEntities(1):
                g.model.mesh.setTransfiniteCurve(tag, 3)
            for _, tag in g.model.getEntities(2):
                g.model.mesh.setTransfiniteSurface(tag)
        g.model.mesh.generate(dimension)

    g.initialize(interruptible=False)
    try:
        g.option.setNumber("General.Terminal", 0)
        for cells in ("tets", "wedges", "hexahedra", "plane"):
            names = []
            build(cells)
            for version, binary, parametric, everything in ((2.2, 0, 0, 0), (2.2, 1, 0, 0), (4.1, 0, 0, 1), (4.1, 1, 1, 0), (2.2, 0, 1, 1), (4.1, 0, 1, 0)):
                g.option.setNumber("Mesh.MshFileVersion", version), g.option.setNumber("Mesh.Binary", binary)
                g.option.setNumber("Mesh.SaveParametric", parametric), g.option.setNumber("Mesh.SaveAll", everything)
                names.append(f"{cells}-{version}-{binary}{parametric}{everything}.msh")
                g.write(taut.file(names[-1]))
            g.option.setNumber("Mesh.SaveAll", 0), g.option.setNumber("Mesh.Binary", 0)
            for name in (f"{cells}.vtk",) + ((f"{cells}.mesh",) if cells != "wedges" else ()):  # gmsh leaves wedges out of .mesh
                g.write(taut.file(name))
                names.append(name)
            for name in names:
                round_trip(taut, name, contents, ["deform", "smooth"] if cells in ("tets", "plane") else ["deform"])
    finally:
        g.finalize()


def trimesh(taut):
    """What trimesh writes and reads: colours, normals, materials, scenes."""
    needs("trimesh")
    import trimesh as t
    points, faces = patch()
    colours = np.array([[10 * v, 255 - 10 * v, 7, 255] for v in range(len(points))], np.uint8)
    mesh = t.Trimesh(points, faces, vertex_colors=colours, vertex_normals=[(0, 0.6, 0.8)] * len(points), process=False)

    def load(name):
        return t.load_mesh(taut.file(name), process=False, maintain_order=True)

    def corners(m, normals):
        told = {"triangles": np.asarray(m.triangles, np.float32)}
        if m.visual.kind == "vertex":
            told["colours"] = np.asarray(m.visual.vertex_colors)[m.faces]
        elif getattr(m.visual, "vertex_attributes", None) is not None and "color" in m.visual.vertex_attributes:
            told["colours"] = np.asarray(m.visual.vertex_attributes["color"])[m.faces]
        if normals and "vertex_normals" in m._cache.cache:
            told["normals"] = np.asarray(m._cache.cache["vertex_normals"])[m.faces]  # of the file; else they are computed
        return told
    files = {"in.obj": {"include_normals": True, "include_color": True}, "in.off": {}, "text.ply": {"encoding": "ascii", "vertex_normal": True},
             "binary.ply": {"vertex_normal": True}, "in.stl": {}, "text.stl": {"file_type": "stl_ascii"}}
    for name, options in files.items():
        mesh.export(taut.file(name), **options)
        before = corners(load(name), False)
        for command, out in (("unwrap", "out.obj"), ("atlas", "out.obj"), ("atlas", "out.glb")):
            taut(command, name, "-o", out)
            after = corners(load(out), False)
            assert out == "out.glb" or load(out).visual.kind == "texture", f"{command} {name} {out}: no texture coordinates"
            if "colours" not in after or name.endswith("off"):
                before.pop("colours", None), after.pop("colours", None)
            same(before, after, f"{command} {name} {out}")

    scene = t.Scene()
    material = t.visual.material.PBRMaterial(name="red", baseColorFactor=[255, 0, 0, 255], roughnessFactor=0.25)
    textured = t.Trimesh(points, faces, process=False, vertex_normals=[(0, 0.6, 0.8)] * len(points),
                         visual=t.visual.TextureVisuals(uv=np.array(points)[:, :2], material=material))
    textured.vertex_attributes["_heat"] = np.arange(len(points), dtype=np.float32)
    scene.add_geometry(textured, geom_name="patch", node_name="first", transform=t.transformations.translation_matrix([1, 2, 3]))
    scene.add_geometry(t.creation.box(), geom_name="box", node_name="second", parent_node_name="first", transform=t.transformations.rotation_matrix(1, [0, 0, 1]))

    def told(name):
        s = t.load_scene(taut.file(name), process=False, maintain_order=True)
        return {"geometry": {k: (corners(m, True), repr(getattr(m.visual, "material", None) and [m.visual.material.name, m.visual.material.main_color]),
                                 {a: np.asarray(x)[m.faces] for a, x in m.vertex_attributes.items()}) for k, m in s.geometry.items()},
                "nodes": {n: (s.graph[n][0], s.graph[n][1]) for n in sorted(s.graph.nodes)}}
    scene.export(taut.file("scene.glb"))
    for name, content in t.exchange.gltf.export_gltf(scene).items():
        taut.write("scene.gltf" if name == "model.gltf" else name, content)
    for name in ("scene.glb", "scene.gltf"):
        taut("atlas", name, "-o", "out-" + name)
        before, after = told(name), told("out-" + name)
        before["geometry"]["box"], after["geometry"]["box"] = (x["geometry"]["box"][0]["triangles"] for x in (before, after))  # no material: grey
        same(before, after, name)


def pygltflib(taut):
    """A model of pygltflib, with each attribute of each corner, materials, skins, animations and extras."""
    needs("pygltflib")
    import pygltflib as p
    points, faces = patch()
    n, data, model = len(points), b"", p.GLTF2()
    types = {1: p.SCALAR, 2: p.VEC2, 3: p.VEC3, 4: p.VEC4, 16: p.MAT4}
    kinds = {p.FLOAT: np.float32, p.UNSIGNED_SHORT: np.uint16, p.UNSIGNED_BYTE: np.uint8, p.UNSIGNED_INT: np.uint32}
    widths = {v: k for k, v in types.items()}

    def accessor(values, kind, normalized=False):
        nonlocal data
        values = np.ascontiguousarray(values, kinds[kind])
        bytes_ = values.tobytes()
        model.bufferViews.append(p.BufferView(buffer=0, byteOffset=len(data), byteLength=len(bytes_)))
        data += bytes_ + b"\0" * (-len(bytes_) % 4)
        flat = values.reshape(len(values), -1)
        model.accessors.append(p.Accessor(bufferView=len(model.bufferViews) - 1, componentType=kind, count=len(values), type=types[flat.shape[1]],
                                          normalized=normalized, max=flat.max(0).tolist(), min=flat.min(0).tolist()))
        return len(model.accessors) - 1
    at = np.array(points)
    attributes = p.Attributes(POSITION=accessor(at, p.FLOAT), NORMAL=accessor([(0, 0.6, 0.8)] * n, p.FLOAT), TEXCOORD_0=accessor(at[:, :2], p.FLOAT),
                              TEXCOORD_1=accessor(at[:, :2] / 2, p.FLOAT), COLOR_0=accessor([(v, 2 * v, 3 * v, 255) for v in range(n)], p.UNSIGNED_BYTE, True),
                              JOINTS_0=accessor([(0, 0, 0, 0)] * n, p.UNSIGNED_SHORT), WEIGHTS_0=accessor([(1, 0, 0, 0)] * n, p.FLOAT))
    attributes._HEAT = accessor(np.arange(n) / 3, p.FLOAT)
    target = {"POSITION": accessor(at / 8, p.FLOAT)}
    primitives = [p.Primitive(attributes=attributes, indices=accessor(np.array(f).ravel(), p.UNSIGNED_SHORT), material=k, targets=[target])
                  for k, f in enumerate((faces[:16], faces[16:]))]
    model.meshes = [p.Mesh(name="patch", primitives=primitives, weights=[0.5], extras={"any": [1, "ü"]})]
    model.materials = [p.Material(name="a", doubleSided=True), p.Material(name="b", alphaMode=p.MASK, alphaCutoff=0.25, extras={"k": 1})]
    model.nodes = [p.Node(name="root", mesh=0, skin=0, translation=[1, 2, 3], scale=[2, 2, 2]), p.Node(name="bone")]
    model.skins = [p.Skin(joints=[1], inverseBindMatrices=accessor([np.eye(4).ravel()], p.FLOAT))]
    model.animations = [p.Animation(name="go", samplers=[p.AnimationSampler(input=accessor([0, 1], p.FLOAT), output=accessor([(0, 0, 0), (0, 0, 1)], p.FLOAT))],
                                    channels=[p.AnimationChannel(sampler=0, target=p.AnimationChannelTarget(node=1, path="translation"))])]
    model.scenes, model.scene = [p.Scene(nodes=[0, 1], name="scene")], 0
    model.asset.generator, model.extras = "a test", {"kept": True}
    model.buffers = [p.Buffer(byteLength=len(data))]
    model.set_binary_blob(data)
    model.save_binary(taut.file("in.glb"))
    model.convert_buffers(p.BufferFormat.DATAURI)
    model.save_json(taut.file("in.gltf"))

    def told(name):
        m = p.GLTF2().load(taut.file(name))
        blobs = [m.binary_blob() if b.uri is None else m.get_data_from_buffer_uri(b.uri) if b.uri.startswith("data:") else taut.read(b.uri) for b in m.buffers]

        def numbers(i):
            a = m.accessors[i]
            view, kind = m.bufferViews[a.bufferView], np.dtype(kinds[a.componentType])
            width = widths[a.type] * kind.itemsize
            begin, step = (view.byteOffset or 0) + (a.byteOffset or 0), view.byteStride or width
            rows = [np.frombuffer(blobs[view.buffer], kind, widths[a.type], begin + k * step) for k in range(a.count)]
            return np.array(rows)
        meshes = []
        for mesh in m.meshes:
            for q in mesh.primitives:
                index = numbers(q.indices).ravel()
                own = {k: i for k, i in vars(q.attributes).items() if i is not None}
                coordinates = own.pop("TEXCOORD_0")
                assert m.accessors[coordinates].count == m.accessors[own["POSITION"]].count
                meshes.append((sorted(own), [numbers(own[k])[index] for k in sorted(own)], [m.accessors[own[k]].normalized for k in sorted(own)],
                               [{k: numbers(i)[index] for k, i in (x if isinstance(x, dict) else vars(x)).items() if i is not None} for x in q.targets], q.material, q.mode))
        document = json.loads(m.to_json())
        for key in ("accessors", "bufferViews", "buffers"):
            document.pop(key, None)
        for mesh in document["meshes"]:
            for q in mesh["primitives"]:
                q["attributes"], q["indices"], q["targets"] = sorted(k for k, v in q["attributes"].items() if v is not None), None, None
        for skin in document["skins"]:
            skin["inverseBindMatrices"] = numbers(skin["inverseBindMatrices"])
        for sampler in document["animations"][0]["samplers"]:
            sampler["input"], sampler["output"] = numbers(sampler["input"]), numbers(sampler["output"])
        return {"meshes": meshes, "document": document}
    for name in ("in.glb", "in.gltf"):
        taut("atlas", name, "-o", "out-" + name)
        same(told(name), told("out-" + name), name)


if __name__ == "__main__":
    go_to_python()
    main(meshio, vtk, gmsh, trimesh, pygltflib)
