# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mesh carries comes over to its quads."""

from __future__ import annotations

import bpy
import numpy as np
import shapes


def remeshed(source: bpy.types.Object, faces: int = 600, **settings: object) -> bpy.types.Object:
    shapes.select(source)
    assert bpy.ops.seamstress.quads(faces=faces, **settings) == {"FINISHED"}
    return bpy.context.object


def material_shares(mesh: bpy.types.Mesh) -> np.ndarray:
    index = np.array([polygon.material_index for polygon in mesh.polygons])
    return np.bincount(index, weights=shapes.areas(mesh), minlength=len(mesh.materials)) / shapes.areas(mesh).sum()


def test_materials() -> None:
    source = shapes.cube()
    made = remeshed(source)
    assert [material.name for material in made.data.materials] == ["side", "top"]
    assert np.abs(material_shares(made.data) - material_shares(source.data)).max() < 0.02
    top = np.array([polygon.center.z > 0.999 for polygon in made.data.polygons])
    assert (top == [polygon.material_index == 1 for polygon in made.data.polygons]).all()


def test_borders_of_materials_are_followed() -> None:
    """A round patch of another material on a plane, which nothing but the material marks."""
    source = shapes.grid(24)
    for name in ("out", "in"):
        source.data.materials.append(bpy.data.materials.new(name))
    for polygon in source.data.polygons:
        polygon.material_index = int(polygon.center.length < 0.6)
    made = remeshed(source, 400)
    assert np.abs(material_shares(made.data) - material_shares(source.data)).max() < 0.02


def test_uv_maps() -> None:
    """One island of the layout to each side of the cube: no quad is smeared over a seam."""
    source = shapes.cube()
    made = remeshed(source)
    name = source.data.uv_layers[0].name
    assert [layer.name for layer in made.data.uv_layers] == [name]
    # The layout of a cube is its sides, a quarter of UV to a side of 2.
    shares = shapes.uv_areas(made.data, name) / shapes.areas(made.data)
    assert np.abs(shares - 1.0 / 64.0).max() < 1e-4
    assert abs(shapes.uv_areas(made.data, name).sum() - 0.375) < 1e-4


def test_linear_values_come_over_exactly() -> None:
    """Colors, weights, and attributes that are linear in the position are so on the quads."""
    source = shapes.grid(20)
    mesh = source.data
    places = shapes.positions(mesh)
    shares = (places[:, 0] + 1.0) / 2.0
    colors = np.column_stack([shares, 1.0 - shares, 0.5 * shares, np.ones(len(shares))])
    of_corners = np.array([loop.vertex_index for loop in mesh.loops])
    mesh.attributes.new("paint", "FLOAT_COLOR", "POINT").data.foreach_set("color", colors.astype(np.float32).ravel())
    mesh.attributes.new("bytes", "BYTE_COLOR", "CORNER").data.foreach_set(
        "color", colors[of_corners].astype(np.float32).ravel()
    )
    mesh.attributes.new("height", "FLOAT", "POINT").data.foreach_set("value", (3.0 * shares).astype(np.float32))
    mesh.attributes.new("side", "INT", "POINT").data.foreach_set("value", (places[:, 0] > 0.0).astype(np.int32))
    group = source.vertex_groups.new(name="weight")
    for vertex, share in enumerate(shares):
        group.add([vertex], float(share), "REPLACE")
    made = remeshed(source, 150)
    new = made.data
    wanted = (shapes.positions(new)[:, 0] + 1.0) / 2.0
    corners = np.array([loop.vertex_index for loop in new.loops])
    assert np.abs(shapes.attribute(new, "paint", "color", 4)[:, 0] - wanted).max() < 1e-3
    assert np.abs(shapes.attribute(new, "height") - 3.0 * wanted).max() < 1e-3
    # A byte has steps of 1 / 255, in the curve of sRGB.
    assert np.abs(shapes.attribute(new, "bytes", "color", 4)[:, 0] - wanted[corners]).max() < 0.01
    assert set(shapes.attribute(new, "side")) == {0.0, 1.0}
    weights = np.array([sum(group.weight for group in vertex.groups) for vertex in new.vertices])
    assert np.abs(weights - wanted).max() < 1e-3
    assert [group.name for group in made.vertex_groups] == ["weight"]


def test_faces_keep_their_sets_and_shading() -> None:
    source = shapes.cube()
    sets = np.array([1 + int(np.argmax(np.abs(polygon.normal))) for polygon in source.data.polygons], np.int32)
    source.data.attributes.new(".sculpt_face_set", "INT", "FACE").data.foreach_set("value", sets)
    source.data.polygons.foreach_set("use_smooth", sets != 3)
    made = remeshed(source)
    wanted = np.array([1 + int(np.argmax(np.abs(polygon.normal))) for polygon in made.data.polygons])
    assert (shapes.attribute(made.data, ".sculpt_face_set") == wanted).all()
    assert ([polygon.use_smooth for polygon in made.data.polygons] == (wanted != 3)).all()


def test_marks_of_edges() -> None:
    source = shapes.cube()
    made = remeshed(source)
    for name, value in {"crease_edge": 0.75, "bevel_weight_edge": 0.5, "sharp_edge": 1.0, "uv_seam": 1.0}.items():
        marks = shapes.attribute(made.data, name)
        assert set(marks) == {0.0, value}
        assert abs(shapes.edge_length(made, marks > 0.0) - 8.0) < 0.02


def test_shape_keys() -> None:
    source = shapes.grid(12)
    places = shapes.positions(source.data)
    source.shape_key_add(name="Basis", from_mix=False)
    up = source.shape_key_add(name="Up", from_mix=False)
    up.data.foreach_set("co", (places + [0.0, 0.0, 1.0] * (places[:, :1] + 1.0)).astype(np.float32).ravel())
    up.value, up.slider_max = 0.25, 2.0
    more = source.shape_key_add(name="More", from_mix=False)
    more.relative_key = up
    made = remeshed(source, 100)
    keys = made.data.shape_keys.key_blocks
    assert [key.name for key in keys] == ["Basis", "Up", "More"]
    assert (keys["Up"].value, keys["Up"].slider_max, keys["More"].relative_key.name) == (0.25, 2.0, "Up")
    moved = np.empty(len(made.data.vertices) * 3, np.float32)
    keys["Up"].data.foreach_get("co", moved)
    base = shapes.positions(made.data)
    assert np.abs(moved.reshape(-1, 3) - base - [0.0, 0.0, 1.0] * (base[:, :1] + 1.0)).max() < 1e-3


def test_custom_normals() -> None:
    source = shapes.grid(12)
    mesh = source.data
    lean = np.array([0.6, 0.0, 0.8])
    mesh.normals_split_custom_set(np.tile(lean, (len(mesh.loops), 1)))
    made = remeshed(source, 100)
    assert made.data.has_custom_normals
    normals = np.array([normal.vector for normal in made.data.corner_normals])
    assert np.abs(normals - lean).max() < 1e-3


def test_both_sides_of_symmetry_carry_their_own() -> None:
    source = shapes.grid(12)
    places = shapes.positions(source.data)
    for side, name in ((1.0, "arm.L"), (-1.0, "arm.R")):
        group = source.vertex_groups.new(name=name)
        for vertex, place in enumerate(places):
            group.add([vertex], float(max(side * place[0], 0.0)), "REPLACE")
    mesh = source.data
    layer = mesh.uv_layers.new(name="flat")
    corners = np.array([loop.vertex_index for loop in mesh.loops])
    layer.uv.foreach_set("vector", places[corners, :2].astype(np.float32).ravel())
    mesh.normals_split_custom_set(np.tile([0.6, 0.0, 0.8], (len(mesh.loops), 1)))
    source.shape_key_add(name="Basis", from_mix=False)
    source.shape_key_add(name="Out", from_mix=False).data.foreach_set(
        "co", (places + [0.5, 0, 0]).astype(np.float32).ravel()
    )
    made = remeshed(source, 100, symmetry={"X"})
    places = shapes.positions(made.data)
    corners = np.array([loop.vertex_index for loop in made.data.loops])
    assert np.abs(shapes.attribute(made.data, "flat", "vector", 2) - places[corners, :2]).max() < 1e-3
    normals = np.array([normal.vector for normal in made.data.corner_normals])
    assert np.abs(normals - [0.6, 0.0, 0.8]).max() < 1e-2
    moved = np.empty(len(places) * 3, np.float32)
    made.data.shape_keys.key_blocks["Out"].data.foreach_get("co", moved)
    offsets = moved.reshape(-1, 3) - places
    assert np.abs(offsets - [0.5, 0.0, 0.0]).max() < 1e-3
    weights = np.zeros((len(made.data.vertices), 2))
    for vertex in made.data.vertices:
        for group in vertex.groups:
            weights[vertex.index, group.group] = group.weight
    x = shapes.positions(made.data)[:, 0]
    assert np.abs(weights - np.column_stack([x, -x]).clip(0.0)).max() < 1e-3


def test_choices_are_kept() -> None:
    """Of three UV maps and two colors the second is shown, the last is rendered; a note goes along."""
    source = shapes.grid(8)
    mesh = source.data
    for name in "abc":
        mesh.uv_layers.new(name=name)
    for name in ("red", "blue"):
        mesh.color_attributes.new(name, "FLOAT_COLOR", "POINT")
    mesh.uv_layers["b"].active = True
    mesh.uv_layers["c"].active_render = True
    mesh.color_attributes.active_color_index = 1
    mesh.color_attributes.render_color_index = 0
    mesh["note"] = "keep"
    made = remeshed(source, 64).data
    assert made.uv_layers.active.name == "b" and made.uv_layers["c"].active_render
    assert made.color_attributes.active_color.name == "blue" and made.color_attributes.render_color_index == 0
    assert made["note"] == "keep"


def test_attributes_can_be_left_behind() -> None:
    source = shapes.cube()
    made = remeshed(source, use_attributes=False)
    assert not made.data.uv_layers and "crease_edge" not in made.data.attributes
