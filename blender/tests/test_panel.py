# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel, menus, presets and texts."""

from __future__ import annotations

import ast
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest
import seamstress
import shapes
from seamstress import panel, running, settings
from seamstress.jobs import Failure
from seamstress.remeshing import SEAMSTRESS_OT_quads
from seamstress.unwrapping import SEAMSTRESS_OT_map

HELD = [(settings.QuadSettings, "quads", SEAMSTRESS_OT_quads), (settings.MapSettings, "map", SEAMSTRESS_OT_map)]
#: What tooltips of numbers say of their unit.
UNITS = ("units of the scene", "in degrees", "Number of", "without unit", "many times", "lengths of the edge", "0 gives")


class Layout:
    """Stands for a layout, and writes down what is drawn. What is drawn has to exist."""

    def __init__(self, drawn: list[str]) -> None:
        self.drawn = drawn

    def prop(self, held: object, name: str, **_: object) -> None:
        assert name in held.bl_rna.properties
        self.drawn.append(name)

    def prop_search(self, held: object, name: str, where: bpy.types.ID, listed: str, **_: object) -> None:
        assert listed in where.bl_rna.properties
        self.prop(held, name)

    def operator(self, name: str, **_: object) -> SimpleNamespace:
        module, function = name.split(".")
        assert getattr(getattr(bpy.ops, module), function).get_rna_type()
        self.drawn.append(name)
        return SimpleNamespace()

    def label(self, text: str, **_: object) -> None:
        self.drawn.append(text)

    def progress(self, factor: float, text: str) -> None:
        self.drawn.append(f"{text} {factor:.1f}")

    def separator(self) -> None:
        pass

    def _part(self, **_: object) -> Layout:
        return Layout(self.drawn)

    row = column = box = split = _part


def drawn(kind: type) -> list[str]:
    found: list[str] = []
    kind.draw(SimpleNamespace(layout=Layout(found)), bpy.context)
    return found


def test_the_panels_show_every_setting() -> None:
    shapes.monkey()
    for (kind, name, operator), shown in zip(HELD, (panel.SEAMSTRESS_PT_quads, panel.SEAMSTRESS_PT_map)):
        held = getattr(bpy.context.scene.seamstress, name)
        seen = set()
        for target in ("FACES", "EDGE", "RATIO"):
            held.creases = "ANGLE"
            if name == "quads":
                held.target = target
                held.density = {"FACES": "NONE", "EDGE": "GROUP", "RATIO": "COLOR"}[target]
            seen |= set(drawn(shown))
        assert seen == {*settings.names(kind), operator.bl_idname}


def test_the_panel_of_the_last_operation_has_every_setting() -> None:
    shapes.monkey()
    for kind, name, operator in HELD:
        assert {"REGISTER", "UNDO", "PRESET"} <= operator.bl_options
        found: list[str] = []
        held = getattr(bpy.context.scene.seamstress, name)
        panels = {"quads": panel.draw_quads, "map": panel.draw_map}
        panels[name](Layout(found), held)
        own: list[str] = []
        operator.draw(SimpleNamespace(layout=Layout(own), bl_rna=held.bl_rna, **settings_of(kind, held)), bpy.context)
        assert own == found


def settings_of(kind: type, held: object) -> dict[str, object]:
    return {name: getattr(held, name) for name in settings.names(kind)}


def test_the_panel_shows_figures_of_the_mesh_and_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    shapes.monkey()
    bpy.ops.seamstress.seamless_uv()
    assert {"Certified seamless map", "Cones", "Flipped triangles"} <= set(drawn(panel.SEAMSTRESS_PT_work))
    monkeypatch.setattr(running, "current", SimpleNamespace(progress=("Suzanne: layout", 0.5)))
    assert drawn(panel.SEAMSTRESS_PT_work) == ["Suzanne: layout 0.5", "seamstress.stop"]
    assert not bpy.ops.seamstress.quads.poll()


def test_stop_ends_what_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []
    monkeypatch.setattr(running, "current", SimpleNamespace(cancel=lambda: calls.append("cancel")))
    assert bpy.ops.seamstress.stop() == {"FINISHED"}
    assert calls == ["cancel"] and running.current is None
    assert not bpy.ops.seamstress.stop.poll()


def test_menus_have_the_operators() -> None:
    for draw, names in (
        (panel.draw_object_menu, ["seamstress.quads", "seamstress.check"]),
        (panel.draw_uv_menu, ["seamstress.seamless_uv"]),
    ):
        found: list[str] = []
        draw(SimpleNamespace(layout=Layout(found)), bpy.context)
        assert found == names


def test_operators_have_the_settings_of_the_panel() -> None:
    for kind, name, operator in HELD:
        held = getattr(bpy.context.scene.seamstress, name)
        wanted = getattr(bpy.ops.seamstress, operator.bl_idname.split(".")[1]).get_rna_type().properties
        for setting in settings.names(kind):
            assert setting in wanted and setting in held.bl_rna.properties
            assert held.bl_rna.properties[setting].name == wanted[setting].name


def test_tooltips_say_units() -> None:
    for _, name, _ in HELD:
        held = getattr(bpy.context.scene.seamstress, name)
        for setting in held.bl_rna.properties:
            if setting.identifier in {"rna_type", "name"}:
                continue
            assert setting.name and setting.description, setting.identifier
            if setting.type in {"INT", "FLOAT"}:
                assert any(unit in setting.description for unit in UNITS), setting.identifier


@pytest.mark.parametrize("name", ["quads", "map"])
def test_presets_that_come_along(name: str) -> None:
    folder = Path(seamstress.PRESETS, "seamstress", name)
    assert str(folder) in bpy.utils.preset_paths(f"seamstress/{name}")
    held = getattr(bpy.context.scene.seamstress, name)
    files = sorted(folder.glob("*.py"))
    assert len(files) >= 2
    for file in files:
        bpy.ops.script.execute_preset(filepath=str(file), menu_idname=f"SEAMSTRESS_PT_{name.rstrip('s')}_presets")
        lines = [line for line in file.read_text().splitlines() if line.startswith("held.")]
        for line in lines:
            key, value = line.removeprefix("held.").split(" = ")
            assert getattr(held, key) == eval(value)


def test_presets_are_written_and_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("BLENDER_USER_SCRIPTS", str(tmp_path))
    held = bpy.context.scene.seamstress.quads
    held.faces, held.marks, held.original = 1234, {"SEAM"}, "REPLACE"
    assert bpy.ops.seamstress.add_quad_preset(name="mine") == {"FINISHED"}
    (written,) = [
        Path(path, "mine.py") for path in bpy.utils.preset_paths("seamstress/quads") if Path(path, "mine.py").exists()
    ]
    held.faces, held.marks, held.original = 10, set(), "HIDE"
    try:
        bpy.ops.script.execute_preset(filepath=str(written), menu_idname="SEAMSTRESS_PT_quad_presets")
    finally:
        written.unlink()
    assert (held.faces, held.marks, held.original) == (1234, {"SEAM"}, "REPLACE")


def spoken(call: ast.Call) -> ast.expr | None:
    """What a call tells people, if that is a text of its own rather than one that was translated."""
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    at = {"Unfit": 0, "poll_message_set": 0, "report": 1}.get(name)
    told = call.args[at] if at is not None and len(call.args) > at else None
    return told if isinstance(told, (ast.Constant, ast.JoinedStr)) else None


def test_texts_can_be_translated() -> None:
    """Blender translates labels and tooltips itself; messages go through its tables one by one."""
    texts, untranslated = set(), []
    for file in Path(seamstress.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if not isinstance(node, ast.Call):
                continue
            if spoken(node) is not None:
                untranslated.append(f"{file.name}:{node.lineno}")
            if getattr(node.func, "id", "") in {"rpt", "iface"} and isinstance(node.args[0], ast.Constant):
                texts.add(node.args[0].value)
    assert not untranslated
    assert {"{} has no faces", "Cancelled; nothing was changed", "Certified seamless map"} <= texts


def test_failures_are_translated_with_what_stands_in_their_braces() -> None:
    failure = Failure("The package {} is missing", "numpy")
    assert str(failure) == "The package numpy is missing"
    assert failure.translated({"The package {} is missing": "{} fehlt"}.get) == "numpy fehlt"
    assert Failure("edge {0-1} has 3 faces").translated(str) == "edge {0-1} has 3 faces"
