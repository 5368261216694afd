# SPDX-License-Identifier: MIT
"""Files."""

from __future__ import annotations

import os
import threading

import numpy as np
import pytest

import taut

OBJ = "# a comment\nv 0 0 0\nv 1 0 0 # here\nv 1 1 0\nv 0 1 0\ng square\nf 1 2 3 4\n"


@pytest.fixture
def square(tmp_path):
    path = tmp_path / "square.obj"
    path.write_text(OBJ)
    return path


def test_a_surface_is_read_and_written_like_it_was(square, tmp_path):
    mesh = taut.read(square)
    assert len(mesh.F) == 2 and set(mesh.F.ravel()) == {0, 1, 2, 3} and mesh.polygons.tolist() == [0, 0] and mesh.corner_uv is None
    made = taut.unwrap(*mesh)
    taut.write(tmp_path / "out.obj", like=mesh, uv=made)
    text = (tmp_path / "out.obj").read_text()
    assert text.startswith("# a comment\nv 0 0 0\nv 1 0 0 # here\n") and text.count("vt ") == 4
    again = taut.read(tmp_path / "out.obj")
    assert (again.corner_uv == made.uv[again.F]).all()


def test_atlases_and_cut_maps_are_written_with_seams(tmp_path, torus):
    V, F = torus
    made = taut.atlas(V, F, single=True)
    for name in ("new.obj", "new.glb"):
        taut.write(tmp_path / name, V=V, F=F, uv=made)
        mesh = taut.read(tmp_path / name)
        assert np.allclose(mesh.corner_uv, made.corner_uv, atol=1e-7)
    taut.write(tmp_path / "again.glb", like=tmp_path / "new.glb", uv=made)
    assert np.allclose(taut.read(tmp_path / "again.glb").corner_uv, made.corner_uv, atol=1e-7)
    cut = taut.unwrap(V, F, cut=True)
    taut.write(tmp_path / "cut.obj", V=V, F=F, uv=cut)
    assert taut.unwrap(*taut.read(tmp_path / "cut.obj")).certified


def test_a_volume_keeps_its_groups_and_takes_other_places(tmp_path, bar):
    V, C = bar
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(V))]
    lines += [f"{x} {y} {z} 7" for x, y, z in V.astype(int)]
    lines += ["Tetrahedra", str(len(C))] + [" ".join(map(str, c + 1)) + " 3" for c in C] + ["End", ""]
    path = tmp_path / "bar.mesh"
    path.write_text("\n".join(lines))
    mesh = taut.read(path)
    assert (np.sort(mesh.C) == np.sort(C)).all() and any("3" in name for name in mesh.groups)
    taut.write(tmp_path / "moved.mesh", like=mesh, x=V * 2)
    assert (taut.read(tmp_path / "moved.mesh").V == V * 2).all()


def test_places_of_a_surface(square, tmp_path):
    mesh = taut.read(square)
    taut.write(tmp_path / "moved.obj", like=square, x=mesh.V + [0, 0, 0.1])
    assert (taut.read(tmp_path / "moved.obj").V == mesh.V + [0, 0, 0.1]).all()


def test_faults_of_files_are_named(tmp_path, square):
    with pytest.raises(taut.FileError) as e:
        taut.read(tmp_path / "nowhere.obj")
    assert "nowhere.obj" in e.value.path and isinstance(e.value, OSError)
    (tmp_path / "bad.obj").write_text("v 0 0\nf 1 2 3\n")
    with pytest.raises(taut.FileError, match="line 1"):
        taut.read(tmp_path / "bad.obj")
    with pytest.raises(taut.ParameterError, match="give one of them"):
        taut.write(tmp_path / "x.obj", like=square)
    with pytest.raises(taut.ParameterError, match="uv"):
        taut.write(tmp_path / "x.obj", like=square, uv=np.zeros((3, 2)))


def test_a_new_file_needs_no_texture_coordinates(tmp_path, bowl):
    V, F = bowl
    V = V / 3
    taut.write(tmp_path / "bare.obj", V=V, F=F)
    mesh = taut.read(tmp_path / "bare.obj")
    assert (mesh.V == V).all() and (mesh.F == F).all() and mesh.corner_uv is None
    assert [p.name for p in tmp_path.iterdir()] == ["bare.obj"]
    with pytest.raises(taut.FileError) as e:
        taut.write(tmp_path / "nowhere" / "bare.obj", V=V, F=F)
    assert "nowhere" in e.value.path
    with pytest.raises(taut.ParameterError, match="uv"):
        taut.write(tmp_path / "bare.glb", V=V, F=F)


def test_a_new_file_takes_texture_coordinates_by_corner(tmp_path):
    V, F = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]]), np.array([[0, 1, 2], [0, 2, 3]])
    uv = np.array([[[0, 0], [1, 0], [1, 1]], [[2, 0], [3, 1], [2, 1.0]]])
    taut.write(tmp_path / "corners.obj", V=V, F=F, uv=uv)
    mesh = taut.read(tmp_path / "corners.obj")
    assert (mesh.corner_uv == uv).all() and (mesh.V[mesh.F] == V[F]).all()


def test_kinds_of_files_are_listed(tmp_path):
    (tmp_path / "x.unknown").write_text("")
    with pytest.raises(taut.FileError, match=r"[.]obj.*[.]glb.*[.]mesh"):
        taut.read(tmp_path / "x.unknown")
    with pytest.raises(taut.FileError, match="No such file"):
        taut.read(tmp_path / "missing.unknown")


def test_devices_are_listed():
    assert any(not d.refusal for d in taut.devices())


def ways_of_writing():
    """Each way to write one file, as a function of its path."""
    V, F = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2]])
    uv = V[:, :2]
    piece = taut.patterns.Piece(uv, [], [0], uv[F])

    def dxf(path):
        pytest.importorskip("ezdxf")
        taut.patterns.write_dxf(path, [piece])

    return {
        "bare": lambda path: taut.write(path, V=V, F=F),
        "textured": lambda path: taut.write(path, V=V, F=F, uv=uv),
        "xatlas": lambda path: taut.compat.xatlas.export(path, V, F, uv),
        "patch": lambda path: taut.cortex.write_patch(path, [0, 1, 2], V),
        "dxf": dxf,
    }


@pytest.mark.parametrize("way", ways_of_writing())
def test_what_is_written_keeps_links_and_modes_and_follows_no_planted_ones(tmp_path, way):
    write = ways_of_writing()[way]
    target, link, mine = tmp_path / "target.obj", tmp_path / "link.obj", tmp_path / "mine.txt"
    target.write_text("old")
    target.chmod(0o600)
    link.symlink_to("target.obj")
    mine.write_text("mine")
    for name in ("link.obj", "target.obj"):
        (tmp_path / f"{name}.{os.getpid()}.part").symlink_to("mine.txt")
    write(link)
    assert link.is_symlink() and target.read_bytes() != b"old" and target.stat().st_mode & 0o777 == 0o600
    assert mine.read_text() == "mine" and len(list(tmp_path.iterdir())) == 5
    with pytest.raises(taut.FileError):
        write(tmp_path / "nowhere" / "x.obj")


def test_arguments_that_would_have_no_effect_are_refused(square, tmp_path):
    V, F = taut.read(square)
    out = tmp_path / "out.obj"
    for field, given in [("V", {"like": square, "x": V, "V": V}), ("F", {"like": square, "x": V, "F": F}),
                         ("x", {"V": V, "F": F, "x": V}), ("x", {"like": square})]:
        with pytest.raises(taut.ParameterError) as e:
            taut.write(out, **given)
        assert e.value.field == field and not out.exists()
    for field in ("zone", "texcoord_set"):
        with pytest.raises(taut.ParameterError, match=field):
            taut.read(square, **{field: 1})
    with pytest.raises(taut.ParameterError, match="texcoord_set"):
        taut.read(square, texcoord_set=10**12)


def test_a_name_that_says_another_format_is_refused(square, tmp_path):
    V, F = taut.read(square)
    (tmp_path / "a.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                    "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                    "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    taut.write(tmp_path / "a.glb", V=V, F=F, uv=V[:, :2])
    for name, given in [("o.ply", {"like": tmp_path / "a.ply", "uv": np.eye(3)[:, :2]}), ("o.stl", {"like": square, "x": V}),
                        ("o.glb", {"like": square, "uv": V[:, :2]}), ("o.txt", {"like": square, "x": V}),
                        ("o.glb", {"like": tmp_path / "a.glb", "x": V})]:
        with pytest.raises(taut.ParameterError, match="path: is .* but must end with|x: places of a glTF model stay"):
            taut.write(tmp_path / name, **given)
        assert not (tmp_path / name).exists()
    taut.write(tmp_path / "o.obj", like=tmp_path / "a.ply", uv=np.eye(3)[:, :2])
    taut.write(tmp_path / "o.PLY", like=tmp_path / "a.ply", x=np.eye(3))


@pytest.mark.parametrize("z", [0.0, 5.0])
def test_quads_of_the_plane_are_smoothed_as_they_are_read(tmp_path, z):
    lines = ["# vtk DataFile Version 3.0", "plate", "ASCII", "DATASET UNSTRUCTURED_GRID", "POINTS 9 double"]
    lines += [f"{i + 0.2 * (i == j == 1)} {j} {z}" for j in range(3) for i in range(3)]
    lines += ["CELLS 4 20", *(f"4 {a} {a + 1} {a + 4} {a + 3}" for a in (0, 1, 3, 4)), "CELL_TYPES 4", *"9999", ""]
    (tmp_path / "plate.vtk").write_text("\n".join(lines))
    mesh = taut.read(tmp_path / "plate.vtk")
    made = taut.smooth(*mesh)
    assert np.allclose(made.x[4], [1, 1], atol=0.01)
    taut.write(tmp_path / "out.vtk", like=mesh, x=made.x)
    assert (taut.read(tmp_path / "out.vtk").V == np.c_[made.x, np.full(9, z)]).all()


def test_names_of_files_that_are_none_and_coordinates_that_fit_no_corner_are_refused(tmp_path):
    V, F = [[0, 0, 0], [1, 0, 0], [0, 1, 0.0]], [[0, 1, 2]]
    (tmp_path / "a").write_text("kept")
    for name in (f"{tmp_path}/a\0.obj", None, 3, f"{tmp_path}/\udcff.obj"):
        with pytest.raises(taut.ParameterError, match="path: is"):
            taut.write(name, V=V, F=F)
        with pytest.raises(taut.ParameterError, match="path: is"):
            taut.read(name)
    with pytest.raises(taut.ParameterError, match="like: is 3"):
        taut.write(tmp_path / "b.obj", like=3, uv=V)
    assert (tmp_path / "a").read_text() == "kept" and [p.name for p in tmp_path.iterdir()] == ["a"]
    taut.write(os.fsencode(tmp_path / "b.obj"), V=V, F=F)
    assert taut.read(os.fsencode(tmp_path / "b.obj")).F.tolist() == F
    for uv in ("b.obj", np.full((2, 3, 2), np.nan), np.full((1, 2, 3), np.nan), [[[0, np.nan], [1, np.inf], [0, 1]]]):
        with pytest.raises(taut.ParameterError, match="uv: "):
            taut.write(tmp_path / "c.obj", V=V, F=F, uv=uv)
    assert not (tmp_path / "c.obj").exists()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes")
def test_a_thread_may_read_the_pipe_that_is_written(bowl, tmp_path):
    os.mkfifo(tmp_path / "pipe.obj")
    found = []
    reader = threading.Thread(target=lambda: found.append((tmp_path / "pipe.obj").read_text()), daemon=True)
    reader.start()
    V, F = bowl
    taut.write(tmp_path / "pipe.obj", V=V, F=F, uv=V[:, :2])
    reader.join(30)
    assert found and found[0].count("vt ") == len(V)
