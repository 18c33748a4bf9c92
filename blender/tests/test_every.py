# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator on every kind of mesh: it does its work or says why not, and Blender's data stays sound."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import pytest
import shapes
from test_quads import non_manifold


def in_edit_mode() -> bpy.types.Object:
    source = shapes.monkey()
    bpy.ops.object.mode_set(mode="EDIT")
    return source


def with_modifiers() -> bpy.types.Object:
    source = shapes.cube(cuts=3)
    source.modifiers.new("Mirror", "MIRROR")
    source.modifiers.new("Subdivision", "SUBSURF")
    return source


def with_shape_keys() -> bpy.types.Object:
    source = shapes.monkey()
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Wide").data[0].co.x += 0.1
    return source


def polygons() -> bpy.types.Object:
    """Prisms have two faces of many corners."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=24)
    return bpy.context.object


MESHES: dict[str, Callable[[], bpy.types.Object]] = {
    "monkey": shapes.monkey,
    "creased cube of two materials with UVs": lambda: shapes.cube(cuts=7),
    "plane with a hole": lambda: shapes.grid(12, hole=(3, 3, 7, 8)),
    "non-manifold": non_manifold,
    "with modifiers": with_modifiers,
    "in edit mode": in_edit_mode,
    "with shape keys": with_shape_keys,
    "polygons": polygons,
    "single triangle": lambda: shapes.added("Triangle", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]),
}
OPERATORS: dict[str, Callable[[], set[str]]] = {
    "quads, hide": lambda: bpy.ops.seamstress.quads(faces=400),
    "quads, replace": lambda: bpy.ops.seamstress.quads(faces=400, original="REPLACE"),
    "map": lambda: bpy.ops.seamstress.seamless_uv(use_checker=True),
    "check": lambda: bpy.ops.seamstress.check(),
}


@pytest.mark.parametrize("operator", OPERATORS)
@pytest.mark.parametrize("mesh", MESHES)
def test_operators_do_their_work(mesh: str, operator: str) -> None:
    source = MESHES[mesh]()
    assert OPERATORS[operator]() == {"FINISHED"}
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for found in bpy.data.meshes:
        # Blender's own check, which is true if it had to mend something.
        assert not found.validate(verbose=True)
    if operator.startswith("quads"):
        made = bpy.context.object.data
        assert shapes.are_quads(made)
        assert 360 <= len(made.polygons) <= 440
    elif operator == "map":
        assert source.data.uv_layers.active.name == "Seamless"


@pytest.mark.parametrize("operator", OPERATORS)
def test_empty_meshes_are_named_and_left(operator: str) -> None:
    empty = shapes.added("Empty", [], [])
    with pytest.raises(RuntimeError, match="Empty has no faces"):
        OPERATORS[operator]()
    assert bpy.data.objects[:] == [empty] and not empty.hide_get()


@pytest.mark.parametrize("operator", OPERATORS)
def test_operators_are_a_step_of_undo(operator: str) -> None:
    """Each makes a step of its own, which brings back all that it has changed."""
    shapes.monkey()
    bpy.ops.ed.undo_push(message="before")

    def state() -> object:
        (mesh,) = (object.data for object in bpy.data.objects if object.name == "Suzanne")
        return len(bpy.data.objects), len(mesh.polygons), mesh.uv_layers.keys(), bpy.data.objects["Suzanne"].hide_get()

    before = state()
    assert CALLS[operator]() == {"FINISHED"}
    assert state() != before or operator == "check"
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.ed.undo()
    assert state() == before


#: As the interface calls them, with a step of undo.
CALLS: dict[str, Callable[[], set[str]]] = {
    "quads, hide": lambda: bpy.ops.seamstress.quads("EXEC_DEFAULT", True, faces=400),
    "quads, replace": lambda: bpy.ops.seamstress.quads("EXEC_DEFAULT", True, faces=400, original="REPLACE"),
    "map": lambda: bpy.ops.seamstress.seamless_uv("EXEC_DEFAULT", True),
    "check": lambda: bpy.ops.seamstress.check("EXEC_DEFAULT", True),
}


@pytest.mark.parametrize("operator", OPERATORS)
def test_instances_of_collections_are_worked_on(operator: str) -> None:
    source = shapes.grid(8)
    bpy.context.collection.objects.unlink(source)
    part = bpy.data.collections.new("Part")
    part.objects.link(source)
    instance = bpy.data.objects.new("Instance", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", part
    bpy.context.collection.objects.link(instance)
    source.data.polygons[9].flip()
    shapes.select(instance)
    assert OPERATORS[operator]() == {"FINISHED"}
    if operator == "quads, replace":
        assert 360 <= len(source.data.polygons) <= 440
    elif operator == "quads, hide":
        assert [object.hide_viewport for object in part.objects] == [True, False]
    elif operator == "map":
        assert "Seamless" in source.data.uv_layers
    else:
        assert sum(edge.select for edge in source.data.edges) == 4
