# SPDX-License-Identifier: MIT
"""The zip of the add-on: its layout, and Blender's own judgement of it."""

import ast
import os
import pathlib
import re
import subprocess
import sys
import textwrap
import tomllib
import types
import zipfile

import bpy
import pytest
import taut_uv
from taut_uv import dragging, operators, panel, running

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = pathlib.Path(bpy.utils.system_resource("SCRIPTS"))
SCRIPT = ROOT / "scripts" / "blender-addon"


def make(folder, *wheels):
    out = folder / "addon.zip"
    subprocess.run(
        [sys.executable, SCRIPT, "--out", out, *(["--wheel", *wheels] if wheels else [])],
        check=True,
        capture_output=True,
    )
    return out


def test_the_zip_is_an_extension(tmp_path):
    out = make(tmp_path)
    with zipfile.ZipFile(out) as archive:
        names = set(archive.namelist())
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
    assert {"__init__.py", "blender_manifest.toml", "LICENSE", "core/__init__.py"} <= names
    assert not any("__pycache__" in n or "test" in n or n.startswith(("/", "..")) for n in names)
    assert manifest["schema_version"] == "1.0.0" and manifest["type"] == "add-on" and manifest["id"] == "taut_uv"
    for key in ("version", "name", "tagline", "maintainer", "blender_version_min", "license"):
        assert manifest[key]
    assert len(manifest["tagline"]) <= 64 and not manifest["tagline"].endswith(".")
    info = taut_uv.bl_info
    assert manifest["version"] == ".".join(map(str, info["version"]))
    assert manifest["blender_version_min"] == ".".join(map(str, info["blender"]))
    header = (ROOT / "include" / "taut" / "version.hpp").read_text()
    assert f'"{manifest["version"]}' in re.search(r"TAUT_VERSION_STRING (.*)", header)[1]
    assert make(tmp_path).read_bytes() == out.read_bytes()


def test_blender_finds_nothing_wrong_with_it(tmp_path):
    tools = list(SCRIPTS.glob("addons_core/bl_pkg/cli/blender_ext.py"))
    if not tools:
        pytest.skip("this Blender has no tool for extensions")
    run = subprocess.run([sys.executable, tools[0], "validate", make(tmp_path)], capture_output=True, text=True)
    assert run.returncode == 0 and "Success" in run.stdout, run.stdout + run.stderr


def wheel_of_build(folder):
    """The package of the build tree as a wheel."""
    import taut

    version = f"{sys.version_info.major}{sys.version_info.minor}"
    wheel = folder / f"taut-1.0.0-cp{version}-cp{version}-manylinux_2_17_x86_64.whl"
    home = pathlib.Path(taut.__file__).parent
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_STORED) as archive:
        for path in [*home.glob("*.py"), *home.glob("*.so"), *home.glob("compat/*.py")]:
            archive.write(path, f"taut/{path.relative_to(home)}")
        for path in (home.parent / "taut.libs").glob("*"):  # of a wheel that scripts/wheel has made
            archive.write(path, f"taut.libs/{path.name}")
        info = "taut-1.0.0.dist-info"
        archive.writestr(f"{info}/METADATA", "Metadata-Version: 2.1\nName: taut\nVersion: 1.0.0\n")
        tag = f"cp{version}-cp{version}-manylinux_2_17_x86_64"
        archive.writestr(f"{info}/WHEEL", f"Wheel-Version: 1.0\nRoot-Is-Purelib: false\nTag: {tag}\n")
        archive.writestr(f"{info}/RECORD", "")
    return wheel


def test_blender_installs_it_with_the_package_inside_and_makes_an_atlas(tmp_path):
    if not hasattr(bpy.ops, "extensions") or sys.platform != "linux":
        pytest.skip("this Blender has no extensions, or no Linux is under it")
    out = make(tmp_path, wheel_of_build(tmp_path))
    program = textwrap.dedent(f"""
        import bpy
        import addon_utils
        addon_utils.enable("bl_pkg")
        bpy.ops.extensions.package_install_files(repo="user_default", filepath={str(out)!r}, enable_on_install=True)
        assert "bl_ext.user_default.taut_uv" in bpy.context.preferences.addons
        bpy.ops.mesh.primitive_torus_add()
        assert bpy.ops.taut.atlas() == {{"FINISHED"}}
        import taut
        print("from", taut.__file__)
        bpy.ops.preferences.addon_disable(module="bl_ext.user_default.taut_uv")
        assert not hasattr(bpy.types.Scene, "taut")
    """)
    resources = tmp_path / "resources"
    env = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"} | {"BLENDER_USER_RESOURCES": str(resources)}
    run = subprocess.run([sys.executable, "-c", program], env=env, capture_output=True, text=True, timeout=120)
    assert run.returncode == 0, run.stdout + run.stderr
    assert f"from {resources}" in run.stdout


def test_what_computes_knows_no_blender():
    for path in (ROOT / "blender" / "taut_uv" / "core").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and node.level == 0:
                names = [node.module]
            assert not {n.split(".")[0] for n in names} & {"bpy", "bmesh", "mathutils", "taut_uv"}, path.name
    program = (
        "import sys; sys.modules['bpy'] = None; sys.path.insert(0, sys.argv[1])\n"
        "import taut\nfrom core.surface import from_polygons\nfrom core.atlas import atlas\n"
        "s = from_polygons([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1.0]], [[0, 1, 2, 3]])\n"
        "assert atlas(taut, s).changed.all()"
    )
    subprocess.run([sys.executable, "-c", program, ROOT / "blender" / "taut_uv"], check=True)


def test_files_are_short():
    for path in (ROOT / "blender").rglob("*.py"):
        lines = path.read_text().split("\n")
        assert len(lines) <= 500 and max(map(len, lines)) <= 120, path.name
        assert lines[0].startswith("# SPDX-License-Identifier: MIT")


class Layout:
    """A layout that writes down which operators it shows."""

    def __init__(self, shown):
        self.shown, self.operator_context = shown, ""

    def operator(self, name, **more):
        kind = getattr(bpy.types, "TAUT_OT_" + name.split(".")[1])
        known = set(kind.bl_rna.properties.keys()) | set(kind.__annotations__)
        self.shown.append(name)

        class Given:
            def __setattr__(self, option, value):
                assert option in known, f"{name} has no option {option}"

        return Given()

    def label(self, text):
        self.shown.append(text)

    def prop(self, owner, name, **more):
        assert hasattr(owner, name)

    def prop_search(self, owner, name, *more):
        assert hasattr(owner, name)

    def column(self, align=False):
        return self

    row = column

    def separator(self):
        pass


@pytest.mark.parametrize("kind, area", [(panel.TAUT_PT_view, "VIEW_3D"), (panel.TAUT_PT_editor, "IMAGE_EDITOR")])
def test_the_panel_has_every_operator_and_a_job_is_shown_with_stop(kind, area, monkeypatch):
    bpy.ops.mesh.primitive_cube_add()
    shown = []
    me = types.SimpleNamespace(layout=Layout(shown), button=kind.button)
    context = types.SimpleNamespace(
        scene=bpy.context.scene, area=types.SimpleNamespace(type=area), object=bpy.context.object
    )
    kind.draw(me, context)
    wanted = {c.bl_idname for c in [*operators.CLASSES, dragging.TAUT_OT_live]} - {"taut.stop"}
    assert set(shown) == (wanted if area == "IMAGE_EDITOR" else wanted - {"taut.live"})
    shown.clear()
    panel.uv_menu(me, context)
    assert "taut.unwrap" in shown and "taut.live" in shown
    shown.clear()
    monkeypatch.setattr(running, "current", types.SimpleNamespace(line="island 3 of 7"))
    kind.draw(me, context)
    assert shown == ["island 3 of 7", "taut.stop"]


def test_the_preferences_say_what_is_loaded(monkeypatch):
    assert re.match(r"taut \d.* on ", taut_uv.library_state())

    def missing(folder=""):
        raise running.library.Missing("no taut")

    monkeypatch.setattr(running.library, "taut", missing)
    assert taut_uv.library_state() == "no taut"
