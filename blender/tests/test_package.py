# SPDX-License-Identifier: GPL-3.0-or-later
"""The package: Blender's own rules, and its installation into an empty Blender. `SEAMSTRESS_WHEEL` names the wheel."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import bpy
import pytest

BLENDER = Path(bpy.utils.resource_path("LOCAL"))
RULES = BLENDER / "scripts" / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py"
HERE = Path(__file__).resolve().parents[1]
#: What an artist does first, in a Blender that has nothing but the package.
INSTALLED = """
import json, os, sys
import bpy
bpy.ops.extensions.package_install_files(filepath=sys.argv[1], repo="user_default", enable_on_install=True)
import seamstress_mesh
bpy.ops.mesh.primitive_monkey_add()
made = bpy.ops.seamstress.quads(faces=500)
mapped = bpy.ops.seamstress.seamless_uv()
print("FOUND " + json.dumps({
    "wheel": seamstress_mesh.__file__,
    "made": [*made, *mapped],
    "quads": len(bpy.context.object.data.polygons),
    "enabled": [name for name in bpy.context.preferences.addons.keys() if name.endswith("seamstress")],
}))
sys.stdout.flush()
bpy.ops.preferences.addon_disable(module="bl_ext.user_default.seamstress")
os._exit(0)
"""


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    wheel = os.environ.get("SEAMSTRESS_WHEEL")
    if wheel is None:
        pytest.skip("SEAMSTRESS_WHEEL names no wheel")
    folder = tmp_path_factory.mktemp("package")
    subprocess.run([sys.executable, HERE / "build.py", wheel, "-o", folder], check=True)
    (path,) = folder.glob("*.zip")
    return path


def test_the_rules_of_blender(package: Path) -> None:
    done = subprocess.run([sys.executable, RULES, "validate", package], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_rules_find_faults(package: Path, tmp_path: Path) -> None:
    faulty = tmp_path / "faulty.zip"
    with zipfile.ZipFile(package) as good, zipfile.ZipFile(faulty, "w") as bad:
        for name in good.namelist():
            content = good.read(name)
            if name == "blender_manifest.toml":
                content = content.replace(b'type = "add-on"', b'type = "addon"')
            bad.writestr(name, content)
    done = subprocess.run([sys.executable, RULES, "validate", faulty], capture_output=True, text=True)
    assert done.returncode != 0


def test_blender_builds_the_same(package: Path, tmp_path: Path) -> None:
    """Blender packs what is unpacked into the same files."""
    unpacked = tmp_path / "unpacked"
    with zipfile.ZipFile(package) as ours:
        ours.extractall(unpacked)
        names = set(ours.namelist())
    built = tmp_path / "built.zip"
    command = [sys.executable, RULES, "build", f"--source-dir={unpacked}", f"--output-filepath={built}"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    with zipfile.ZipFile(built) as theirs:
        assert set(theirs.namelist()) == names


def test_wheels_and_platforms_agree(package: Path) -> None:
    with zipfile.ZipFile(package) as opened:
        manifest = tomllib.loads(opened.read("blender_manifest.toml").decode())
        names = opened.namelist()
        assert b"GNU GENERAL PUBLIC LICENSE" in opened.read("LICENSE")
    assert manifest["license"] == ["SPDX:GPL-3.0-or-later"]
    assert [f"wheels/{Path(wheel).name}" for wheel in manifest["wheels"]] == [n for n in names if n.startswith("wheels/")]
    sys.path.insert(0, str(HERE))
    import build

    assert manifest["platforms"] == build.platforms([Path(wheel) for wheel in manifest["wheels"]])


def test_platforms_of_wheels() -> None:
    sys.path.insert(0, str(HERE))
    import build

    tags = ["manylinux_2_17_x86_64.manylinux2014_x86_64", "win_amd64", "macosx_11_0_arm64", "linux_aarch64"]
    wheels = [Path(f"seamstress_mesh-0.1.0-cp39-abi3-{tag}.whl") for tag in tags]
    assert build.platforms(wheels) == ["linux-x64", "linux-arm64", "macos-arm64", "windows-x64"]
    with pytest.raises(SystemExit, match="no platform"):
        build.platforms([Path("seamstress_mesh-0.1.0-cp39-abi3-emscripten_3_wasm32.whl")])


def test_an_empty_blender_installs_it(package: Path, tmp_path: Path) -> None:
    variables = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    variables["BLENDER_USER_RESOURCES"] = str(tmp_path)
    done = subprocess.run(
        [sys.executable, "-c", INSTALLED, package], capture_output=True, text=True, env=variables, timeout=120
    )
    told = [line for line in done.stdout.splitlines() if line.startswith("FOUND ")]
    assert told, done.stdout + done.stderr
    found = json.loads(told[0].removeprefix("FOUND "))
    assert Path(found["wheel"]).is_relative_to(tmp_path)
    assert found["made"] == ["FINISHED", "FINISHED"]
    assert 450 <= found["quads"] <= 550
    assert found["enabled"] == ["bl_ext.user_default.seamstress"]
