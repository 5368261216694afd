# SPDX-License-Identifier: MIT
"""run.py PEER MESH OUT.npz [COMMAND ...]: one peer on one mesh, timed; OUT has coordinates by corner, of a volume (an .npz) by vertex.
Beside it OUT.npz.json. With a command that is the peer: {in} and {out} in it are Wavefront files."""

import json
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from peers import judge, volumes  # noqa: E402


def taut(V, F):
    import taut
    return (lambda: taut.atlas(V, F).corner_uv), taut.__version__


def taut_packing(V, F):
    import taut
    return (lambda: taut.atlas(V, F, prefer="packing").corner_uv), taut.__version__


def taut_xatlas(V, F):
    import taut
    import taut.compat.xatlas as xatlas

    def run():
        _, faces, uv = xatlas.parametrize(V, F)
        return uv[faces]
    return run, taut.__version__


def taut_unwrap(V, F):
    import taut
    return (lambda: taut.unwrap(V, F).uv[F]), taut.__version__


def xatlas(V, F):
    import xatlas

    def run():
        vmapping, faces, uv = xatlas.parametrize(V, F)
        # Corners of a face may come in another order: by their vertices.
        result = np.empty((len(F), 3, 2))
        for k in range(3):
            place = (vmapping[faces] == F[:, k:k + 1]).argmax(1)
            result[:, k] = uv[faces[np.arange(len(F)), place]]
        return result
    return run, xatlas.__version__


def uvunwrap(V, F):
    import uvunwrap
    mesh = uvunwrap.Mesh(V.astype(np.float32), F.astype(np.uint32).ravel())
    return (lambda: np.array(uvunwrap.generate([mesh]).meshes[0].corner_uvs).reshape(-1, 3, 2)), uvunwrap.__version__


def geotex(V, F):
    from importlib.metadata import version

    import geotex
    return (lambda: np.asarray(geotex.make_atlas(V, F.astype(np.uint32))).reshape(-1, 3, 2)), version("geotex")


def meshlab(run_filter):
    def make(V, F):
        from importlib.metadata import version

        import pymeshlab

        def run():
            meshes = pymeshlab.MeshSet(verbose=False)
            meshes.add_mesh(pymeshlab.Mesh(V, F))
            return run_filter(meshes)
        return run, version("pymeshlab")
    return make


def filtered(name):
    """Coordinates by corner after a filter of MeshLab, and the mesh that it leaves, which may be another one."""
    def run_filter(meshes):
        getattr(meshes, name)()
        meshes.set_current_mesh(meshes.mesh_number() - 1)
        made = meshes.current_mesh()
        faces = made.face_matrix()
        uv = made.wedge_tex_coord_matrix().reshape(-1, 3, 2) if made.has_wedge_tex_coord() \
            else made.vertex_tex_coord_matrix()[faces]
        return uv, made.vertex_matrix(), faces
    return run_filter


def open3d(V, F):
    import open3d as o3d
    mesh = o3d.t.geometry.TriangleMesh(o3d.core.Tensor(V.astype(np.float32)), o3d.core.Tensor(F.astype(np.int64)))

    def run():
        mesh.compute_uvatlas(size=1024, gutter=2.0)
        return mesh.triangle.texture_uvs.numpy()
    return run, o3d.__version__


def boundary(F):
    """The longest boundary loop."""
    follow = {}
    inside = {(a, b) for t in F.tolist() for a, b in zip(t, t[1:] + t[:1])}
    for a, b in inside:
        if (b, a) not in inside:
            follow[a] = b
    loops, seen = [], set()
    for start in follow:
        loop = []
        while start not in seen and start in follow:
            seen.add(start)
            loop.append(start)
            start = follow[start]
        loops.append(loop)
    return np.array(max(loops, key=len))


def igl_start(V, F):
    import igl
    b = boundary(F).astype(np.int64)
    circle = np.asarray(igl.map_vertices_to_circle(V, b))[:, :2] * np.sqrt(area(V, F) / np.pi)
    F64 = np.ascontiguousarray(F, dtype=np.int64)
    uv = np.asarray(igl.harmonic(V, F64, b, np.ascontiguousarray(circle), 1))
    if judge.judge(V, F, uv[F])["flips"]:
        # Uniform weights give a start without flips.
        L = igl.adjacency_matrix(F64).astype(float)
        import scipy.sparse as sp
        from scipy.sparse.linalg import spsolve
        L = sp.diags(np.asarray(L.sum(1)).ravel()) - L
        free = np.setdiff1d(np.arange(len(V)), b)
        uv = np.zeros((len(V), 2))
        uv[b] = circle
        uv[free] = spsolve(L[free][:, free].tocsc(), -(L[free][:, b] @ circle))
    return uv


def area(V, F):
    return np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1).sum() / 2


def igl_lscm(V, F):
    from importlib.metadata import version

    import igl
    b = boundary(F).astype(np.int64)
    ends = np.array([b[0], b[len(b) // 2]], dtype=np.int64)

    def run():
        return np.asarray(igl.lscm(V, F.astype(np.int64), ends, np.array([[0.0, 0.0], [1.0, 0.0]]))[0])[F]
    return run, version("libigl")


def igl_arap(V, F):
    from importlib.metadata import version

    import igl

    def run():
        uv = igl_start(V, F)
        data = igl.ARAPData()
        data.with_dynamics = True
        igl.arap_precomputation(V, F.astype(np.int64), 2, np.zeros(0, dtype=np.int32), data)
        for _ in range(10):
            uv = np.asarray(igl.arap_solve(np.zeros((0, 2)), data, np.ascontiguousarray(uv)))
        return uv[F]
    return run, version("libigl")


def igl_slim(V, F):
    from importlib.metadata import version

    import igl

    def run():
        start = igl_start(V, F)
        kind = igl.MappingEnergyType.SYMMETRIC_DIRICHLET if hasattr(igl, "MappingEnergyType") \
            else igl.pyigl_core.MappingEnergyType.SYMMETRIC_DIRICHLET
        data = igl.slim_precompute(np.asfortranarray(V), np.asfortranarray(F, dtype=np.int32), np.asfortranarray(start),
                                   kind, np.zeros(0, dtype=np.int32), np.asfortranarray(np.zeros((0, 2))), 0.0)
        return np.asarray(igl.slim_solve(data, 20))[:, :2][F]
    return run, version("libigl")


def blender(operator, **options):
    def make(V, F):
        import bpy
        bpy.ops.wm.read_factory_settings(use_empty=True)
        mesh = bpy.data.meshes.new("m")
        mesh.from_pydata(V.tolist(), [], F.tolist())
        thing = bpy.data.objects.new("m", mesh)
        bpy.context.collection.objects.link(thing)
        bpy.context.view_layer.objects.active = thing
        thing.select_set(True)
        mesh.uv_layers.new(name="UV")

        def run():
            bpy.ops.object.mode_set(mode="EDIT")
            bpy.ops.mesh.select_all(action="SELECT")
            getattr(bpy.ops.uv, operator)(**options)
            bpy.ops.object.mode_set(mode="OBJECT")
            uv = np.empty(6 * len(F), dtype=np.float32)
            mesh.uv_layers.active.data.foreach_get("uv", uv)
            return uv.reshape(-1, 3, 2)
        return run, bpy.app.version_string
    return make


PEERS = {
    "taut": taut,
    "taut for packing": taut_packing,
    "taut one line of xatlas": taut_xatlas,
    "taut unwrap": taut_unwrap,
    "xatlas": xatlas,
    "uvunwrap": uvunwrap,
    "geotex": geotex,
    "pymeshlab voronoi": meshlab(filtered("generate_voronoi_atlas_parametrization")),
    "pymeshlab harmonic": meshlab(filtered("compute_texcoord_parametrization_harmonic")),
    "pymeshlab lscm": meshlab(filtered("compute_texcoord_parametrization_least_squares_conformal_maps")),
    "open3d uvatlas": open3d,
    "libigl lscm": igl_lscm,
    "libigl arap": igl_arap,
    "libigl slim": igl_slim,
    "blender smart project": blender("smart_project"),
    "blender angle based": blender("unwrap", method="ANGLE_BASED"),
    "blender conformal": blender("unwrap", method="CONFORMAL"),
    "blender minimum stretch": blender("unwrap", method="MINIMUM_STRETCH"),
}


def program(words):
    """A program of its own: it gets the mesh as a Wavefront file, and leaves one with texture coordinates."""
    def make(V, F):
        folder = pathlib.Path(tempfile.mkdtemp())
        names = {"{in}": str(folder / "in.obj"), "{out}": str(folder / "out.obj")}
        with open(names["{in}"], "w", encoding="utf-8") as f:
            f.writelines(f"v {x:.17g} {y:.17g} {z:.17g}\n" for x, y, z in V.tolist())
            f.writelines(f"f {a} {b} {c}\n" for a, b, c in (F + 1).tolist())

        def run():
            subprocess.run([names.get(w, w) for w in words], check=True, stdout=subprocess.DEVNULL)
            return judge.read_obj(names["{out}"])
        return run, ""
    return make


def processor_seconds():
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def main():
    peer, mesh, out, *words = sys.argv[1:]
    if mesh.endswith(".npz"):
        given = [np.load(mesh)[name] for name in ("V", "T", "b", "bc")]
        run, version = volumes.PEERS[peer](*given)
    else:
        V, F = judge.read_off(mesh)
        run, version = (program(words) if words else PEERS[peer])(V, F)
    print("begin", flush=True)
    start, used = time.perf_counter(), processor_seconds()
    made = run()
    seconds, used = time.perf_counter() - start, processor_seconds() - used
    status = pathlib.Path("/proc/self/status").read_text()  # unlike getrusage() it forgets the parent at exec
    peak = int(status.split("VmHWM:")[1].split()[0]) / 1024
    if words:
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    if mesh.endswith(".npz"):
        np.savez(out, x=made)
    else:
        uv, V, F = made if isinstance(made, tuple) else (made, V, F)
        np.savez(out, corner_uv=uv, V=V, F=F)
    pathlib.Path(out + ".json").write_text(
        json.dumps({"seconds": seconds, "processor": used, "megabytes": peak, "version": version}))


if __name__ == "__main__":
    main()
