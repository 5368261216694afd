# SPDX-License-Identifier: MIT
"""Files."""

from __future__ import annotations

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
