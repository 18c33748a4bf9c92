"""The package as a whole: its types, its texts, its command, its documents."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

import seamstress_mesh as sm
from seamstress_mesh import _native, _options

#: Flags of commands that are no keywords: files, output, what `timeout` says.
ELSEWHERE = {"output", "report", "pictures", "picture", "json", "quiet", "time_limit", "help", "cones"}
PICTURES = {"view", "up", "texture_angle", "texture_shift", "texture_period"}


def flags(command: str) -> set[str]:
    return {name for name, _, _ in _native.flags(command)} - ELSEWHERE - PICTURES


def keywords(call: object) -> set[str]:
    names = set(inspect.signature(call).parameters)  # type: ignore[arg-type]
    extra = {"options": _options.MapOptions, "run_options": _options.RunOptions}
    for name in names & set(extra):
        names |= set(extra[name].__annotations__)
    return names - set(extra)


@pytest.mark.parametrize("command, call", [("quad", sm.Surface.quad_mesh), ("integer", sm.Surface.integer_map)])
def test_keywords_are_flags(command: str, call: object) -> None:
    of_surface = set(_options.SurfaceOptions.__annotations__)
    ours = keywords(call) - {"self", "timeout", "progress"} | of_surface
    # The tolerance is that of a map that is given: of `integer_map_of`. Sets of UVs are those of GLB files.
    assert ours == flags(command) - {"tolerance", "uv_set"}


def test_keywords_of_maps_are_flags() -> None:
    ours = keywords(sm.Surface.parametrize) - {"self", "timeout", "progress"} | set(_options.SurfaceOptions.__annotations__)
    assert ours <= flags("map")


@pytest.mark.parametrize(
    "command, call",
    [
        ("check", sm.Surface.certify),
        ("measure", sm.Surface.measure),
        ("extract", sm.Surface.extract_quads),
        ("integer", sm.Surface.integer_map_of),
        ("lab optimize", sm.Surface.optimize),
    ],
)
def test_other_keywords_are_flags(command: str, call: object) -> None:
    ours = keywords(call) - {"self", "uv", "face_uv", "timeout", "progress", "threads", "memory_limit"}
    assert ours <= flags(command)


def test_texts_are_those_of_the_command() -> None:
    texts = {name: text for name, text, _ in _native.flags("quad")}
    document = " ".join((sm.Surface.quad_mesh.__doc__ or "").split())
    for name in ("quads", "smooth", "cone_bias", "features_strict"):
        assert " ".join(texts[name].split()) in document


def test_everything_public_is_documented() -> None:
    for name in sm.__all__:
        thing = getattr(sm, name)
        assert name == "__version__" or inspect.getdoc(thing), name
        if inspect.isclass(thing):
            for method, value in vars(thing).items():
                if not method.startswith("_") and callable(value):
                    assert inspect.getdoc(value), f"{name}.{method}"


def test_types() -> None:
    subprocess.run([sys.executable, "-m", "mypy", "--strict", "-p", "seamstress_mesh"], check=True)


def test_stubs_are_those_of_the_module() -> None:
    check = [sys.executable, "-m", "mypy.stubtest", "seamstress_mesh._native"]
    subprocess.run(check, check=True)


@pytest.mark.parametrize("page", ["README.md", "crates/python/README.md"])
def test_pages_run(page: str, tmp_path: Path) -> None:
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(), re.S)
    assert blocks
    (tmp_path / "samples").symlink_to(ROOT / "samples")
    script = tmp_path / "page.py"
    script.write_text("\n".join(blocks))
    subprocess.run([sys.executable, script], check=True, cwd=tmp_path)


def test_the_command_comes_along(tmp_path: Path) -> None:
    run = [sys.executable, "-m", "seamstress_mesh"]
    version = subprocess.run([*run, "--version"], capture_output=True, text=True, check=True)
    assert version.stdout.split() == ["seamstress", sm.__version__]
    wrong = subprocess.run([*run, "map", "--nothing"], capture_output=True, text=True)
    assert wrong.returncode == 2 and "--nothing" in wrong.stderr
    missing = subprocess.run([*run, "check", "none.obj"], capture_output=True, text=True, cwd=tmp_path)
    assert missing.returncode == 1 and "none.obj" in missing.stderr
