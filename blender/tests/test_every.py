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
