# SPDX-License-Identifier: GPL-3.0-or-later
"""Quad Remesh: counts, features, modifiers, transforms, modes, several objects."""

from __future__ import annotations

import re

import bpy
import numpy as np
import pytest
import shapes
from seamstress.selecting import SELECTED


def quads(**settings: object) -> bpy.types.Object:
    """Runs the operator; the active object after it."""
    assert bpy.ops.seamstress.quads(**settings) == {"FINISHED"}
    return bpy.context.object


def near(found: float, wanted: float, share: float) -> bool:
    return abs(found - wanted) <= share * wanted


@pytest.mark.parametrize("asked", [600, 2000])
def test_count_of_a_monkey(asked: int) -> None:
    source = shapes.monkey()
    made = quads(faces=asked)
    assert near(len(made.data.polygons), asked, 0.1)
    assert shapes.are_quads(made.data)
    assert made.name == "Suzanne quads" and made is not source
    assert source.hide_get() and source.hide_render and len(source.data.polygons) == 500
    assert made.select_get() and not source.select_get()


def test_what_is_selected_is_sound() -> None:
    """As edit mode wants it, and keeps it."""
    shapes.monkey()
    made = quads(faces=500)
    assert all(made.data.attributes[name].data_type == "BOOLEAN" for name in SELECTED if name in made.data.attributes)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert {edge.select for edge in made.data.edges} == {False}


def test_targets_agree() -> None:
    shapes.cube()
    by_length = quads(target="EDGE", edge_length=0.2, original="REPLACE")
    assert near(len(by_length.data.polygons), 600, 0.1)
    shapes.cube()
    by_ratio = quads(target="RATIO", ratio=0.5, original="REPLACE")
    assert near(len(by_ratio.data.polygons), 432, 0.1)


def test_borders_are_kept() -> None:
    shapes.grid(16, hole=(4, 4, 8, 10))
    made = quads(faces=300, creases="NONE")
    assert near(len(made.data.polygons), 300, 0.1)
    assert near(shapes.areas(made.data).sum(), 4.0 - 0.5 * 0.75, 1e-5)
    assert near(shapes.edge_length(made, shapes.border_edges(made.data)), 8.0 + 2.5, 1e-5)


def marked_line(mark: str) -> bpy.types.Object:
    """A plane with a line through it, which nothing but a mark tells."""
    source = shapes.grid(20)
    mesh = source.data
    places = shapes.positions(mesh)
    on_line = [all(abs(places[v, 0] - 0.3) < 1e-6 for v in edge.vertices) for edge in mesh.edges]
    beyond = np.array([polygon.center.x > 0.3 for polygon in mesh.polygons])
    if mark == "MATERIAL":
        for name in "ab":
            mesh.materials.append(bpy.data.materials.new(name))
        mesh.polygons.foreach_set("material_index", beyond.astype(np.int32))
    elif mark == "FACE_SET":
        sets = mesh.attributes.new(".sculpt_face_set", "INT", "FACE")
        sets.data.foreach_set("value", beyond.astype(np.int32) + 1)
    else:
        name = {"SHARP": "sharp_edge", "CREASE": "crease_edge", "BEVEL": "bevel_weight_edge", "SEAM": "uv_seam"}[mark]
        kind = "BOOLEAN" if mark in {"SHARP", "SEAM"} else "FLOAT"
        mesh.attributes.new(name, kind, "EDGE").data.foreach_set("value", on_line)
    return source


def length_at(made: bpy.types.Object, x: float) -> float:
    places = shapes.positions(made.data)
    ends = np.array([edge.vertices[:] for edge in made.data.edges])
    return shapes.edge_length(made, (np.abs(places[ends, 0] - x) < 1e-5).all(axis=1))


@pytest.mark.parametrize("mark", ["SHARP", "CREASE", "BEVEL", "SEAM", "MATERIAL", "FACE_SET"])
def test_marked_edges_are_followed(mark: str) -> None:
    """And only if their mark is chosen."""
    followed = {}
    for marks in ({mark}, set()):
        marked_line(mark)
        made = quads(faces=300, creases="NONE", marks=marks, use_attributes=False)
        followed[bool(marks)] = length_at(made, 0.3)
    assert near(followed[True], 2.0, 1e-4) and followed[False] < 0.5


def test_edges_are_followed_from_an_angle_on() -> None:
    """A plane folded by 30 degrees."""
    for angle, is_followed in ((25.0, True), (35.0, False)):
        source = shapes.grid(20)
        places = shapes.positions(source.data)
        places[:, 2] = np.tan(np.radians(30.0)) * (places[:, 0] - 0.3).clip(0.0)
        source.data.vertices.foreach_set("co", places.astype(np.float32).ravel())
        made = quads(faces=300, creases="ANGLE", angle=np.radians(angle), align=0.0)
        assert (length_at(made, 0.3) > 1.99) == is_followed


def test_modifiers_are_applied_or_kept() -> None:
    source = shapes.cube(cuts=3)
    modifier = source.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = 2
    applied = quads(faces=400)
    assert len(applied.modifiers) == 0 and len(source.modifiers) == 1
    assert shapes.areas(applied.data).sum() < 23.0
    shapes.select(source)
    source.hide_set(False)
    shapes.select(source)
    kept = quads(faces=400, use_modifiers=False)
    assert [modifier.type for modifier in kept.modifiers] == ["SUBSURF"]
    assert near(shapes.areas(kept.data).sum(), 24.0, 1e-3)


def test_scale_is_respected() -> None:
    """Quads are square in the world, and the object stays where it is."""
    source = shapes.grid(10)
    source.scale = (4.0, 1.0, 1.0)
    source.rotation_euler = (0.3, 0.2, 0.1)
    source.location = (5.0, 6.0, 7.0)
    bpy.context.view_layer.update()
    corners = shapes.world(source)
    made = quads(target="EDGE", edge_length=0.25)
    bpy.context.view_layer.update()
    assert made.matrix_world == source.matrix_world
    assert near(len(made.data.polygons), 16.0 / 0.0625, 0.1)
    places = shapes.world(made)
    assert np.allclose(places.min(axis=0), corners.min(axis=0), atol=1e-4)
    assert np.allclose(places.max(axis=0), corners.max(axis=0), atol=1e-4)
    ends = places[np.array([edge.vertices[:] for edge in made.data.edges])]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert lengths.max() < 1.3 * lengths.min()


def test_mirrored_objects_keep_their_outside() -> None:
    source = shapes.cube()
    source.scale = (-1.0, 1.0, 2.0)
    bpy.context.view_layer.update()
    made = quads(faces=400)
    outwards = [polygon.normal.dot(polygon.center) for polygon in made.data.polygons]
    assert min(outwards) > 0.9


def test_flat_objects_are_refused() -> None:
    source = shapes.cube()
    source.scale = (1.0, 0.0, 1.0)
    bpy.context.view_layer.update()
    with pytest.raises(RuntimeError, match="Cube has a scale of zero along an axis"):
        bpy.ops.seamstress.quads(faces=400)


def test_meshes_without_faces_are_refused() -> None:
    shapes.added("Empty", np.empty((0, 3)), [])
    with pytest.raises(RuntimeError, match="Empty has no faces"):
        bpy.ops.seamstress.quads(faces=400)
    shapes.added("Wire", [(0, 0, 0), (1, 0, 0)], [])
    with pytest.raises(RuntimeError, match="Wire has no faces"):
        bpy.ops.seamstress.quads(faces=400)
    assert len(bpy.data.objects) == 2


def non_manifold() -> bpy.types.Object:
    """Three sheets that meet at a line."""
    line = np.linspace(0.0, 1.0, 5)
    vertices, faces = [], []
    for turn in range(3):
        way = np.array([np.cos(turn * 2.0), np.sin(turn * 2.0)])
        for u in line:
            vertices += [(*(u * way), z) for z in line]
    first = {}
    merged = [first.setdefault(tuple(np.round(vertex, 9)), len(first)) for vertex in vertices]
    for turn in range(3):
        at = lambda i, j, turn=turn: merged[turn * 25 + i * 5 + j]  # noqa: E731
        faces += [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i in range(4) for j in range(4)]
    return shapes.added("Sheets", list(first), faces)


def test_non_manifold_meshes_are_repaired_or_refused() -> None:
    non_manifold()
    with pytest.raises(RuntimeError, match="edge .* has 3 faces"):
        bpy.ops.seamstress.quads(faces=100, use_repair=False)
    made = quads(faces=100)
    assert near(len(made.data.polygons), 100, 0.1)
    assert near(shapes.areas(made.data).sum(), 3.0, 1e-4)


def test_edit_mode_is_left_and_entered_again() -> None:
    source = shapes.monkey()
    bpy.ops.object.mode_set(mode="EDIT")
    made = quads(faces=600, original="REPLACE")
    assert made is source and made.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert near(len(made.data.polygons), 600, 0.1)


def test_edits_count_before_edit_mode_is_left() -> None:
    shapes.grid(8)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.resize(value=(3.0, 1.0, 1.0))
    made = quads(faces=100)
    assert near(np.ptp(shapes.positions(made.data)[:, 0]), 6.0, 1e-3)


def test_undo_brings_the_mesh_back() -> None:
    shapes.monkey()
    bpy.ops.ed.undo_push(message="before")
    quads(faces=600, original="REPLACE")
    bpy.ops.ed.undo_push(message="after")
    assert near(len(bpy.data.objects["Suzanne"].data.polygons), 600, 0.1)
    bpy.ops.ed.undo()
    assert len(bpy.data.objects["Suzanne"].data.polygons) == 500
    bpy.ops.ed.redo()
    assert near(len(bpy.data.objects["Suzanne"].data.polygons), 600, 0.1)


def test_several_objects_and_shared_meshes() -> None:
    monkey, cube = shapes.monkey(), shapes.cube()
    twin = monkey.copy()
    bpy.context.collection.objects.link(twin)
    other = monkey.copy()
    bpy.context.collection.objects.link(other)
    shapes.select(monkey, cube, twin)
    quads(faces=500, original="REPLACE")
    assert monkey.data is twin.data is other.data
    assert monkey.data.name == "Suzanne" and [mesh.name for mesh in bpy.data.meshes].count("Suzanne") == 1
    for object in (monkey, cube):
        assert near(len(object.data.polygons), 500, 0.1)


def test_shared_meshes_of_which_one_has_modifiers() -> None:
    plain = shapes.cube(cuts=3)
    smooth = plain.copy()
    bpy.context.collection.objects.link(smooth)
    smooth.modifiers.new("Subdivision", "SUBSURF").levels = 2
    plain.shape_key_add(name="Basis")
    shapes.select(plain, smooth)
    quads(faces=500, original="REPLACE")
    assert plain.data is not smooth.data and not smooth.modifiers
    assert near(shapes.areas(plain.data).sum(), 24.0, 1e-3) and shapes.areas(smooth.data).sum() < 23.0
    assert plain.data.shape_keys is not None and smooth.data.shape_keys is None


def test_new_objects_of_shared_meshes_share_theirs() -> None:
    monkey = shapes.monkey()
    twin = monkey.copy()
    bpy.context.collection.objects.link(twin)
    shapes.select(monkey, twin)
    quads(faces=500)
    made = bpy.context.selected_objects
    assert len(made) == 2 and made[0].data is made[1].data is not monkey.data


def test_one_failure_leaves_the_others() -> None:
    monkey, flat = shapes.monkey(), shapes.grid(4)
    flat.scale = (1.0, 0.0, 1.0)
    shapes.select(monkey, flat)
    bpy.context.view_layer.update()
    assert bpy.ops.seamstress.quads(faces=500, original="REPLACE") == {"FINISHED"}
    assert near(len(monkey.data.polygons), 500, 0.1) and len(flat.data.polygons) == 16


def test_edges_that_cannot_be_followed_are_selected(capfd: pytest.CaptureFixture[str]) -> None:
    """Every edge of a fan: a triangle with all three on the axes would have to be a point."""
    bpy.ops.mesh.primitive_circle_add(vertices=24, fill_type="TRIFAN")
    source = bpy.context.object
    source.data.edges.foreach_set("use_edge_sharp", [True] * len(source.data.edges))
    quads(faces=40)
    told = re.search(r"edges not followed: (.*); the original has them selected", capfd.readouterr().out)
    counts = [int(count) for count in re.findall(r"\d+", told[1])]
    assert sum(counts) == sum(edge.select for edge in source.data.edges) > 0


def test_quads_of_a_tube_run_around_and_along_it() -> None:
    """Between edges and the axis of a tube whose own edges run askew, in degrees from the nearest direction."""
    away = {}
    for align in (0.0, 1.0):
        shapes.tube(48, 24, 0.6)
        made = quads(faces=600, align=align, creases="NONE", use_boundary=False, marks=set())
        ends = shapes.positions(made.data)[np.array([edge.vertices[:] for edge in made.data.edges])]
        along = ends[:, 1] - ends[:, 0]
        angles = np.degrees(np.arccos(np.abs(along[:, 2]) / np.linalg.norm(along, axis=1)))
        away[align] = np.minimum(angles, 90.0 - angles).mean()
    assert away[1.0] < 5.0, away


@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_symmetry(turn: float) -> None:
    source = shapes.monkey()
    source.rotation_euler, source.scale = (0.3, turn, turn), (2.0, 2.0, 3.0)
    bpy.context.view_layer.update()
    made = quads(faces=800, symmetry={"X"})
    assert shapes.are_quads(made.data)
    assert near(len(made.data.polygons), 800, 0.1)
    places = {tuple(place) for place in shapes.positions(made.data) + 0.0}
    assert places == {(-x + 0.0, y, z) for x, y, z in places}
    # The sides are joined: as many pieces as before, which are the head and the eyes.
    assert pieces(made.data) == 3


def test_symmetry_of_several_planes_and_of_a_subdivided_cube() -> None:
    shapes.cube()
    made = quads(faces=600, symmetry={"X", "Y", "Z"})
    places = {tuple(place) for place in shapes.positions(made.data) + 0.0}
    for signs in np.vstack([np.eye(3) * -2 + 1]):
        assert places == {tuple(place) for place in np.array(list(places)) * signs + 0.0}


def test_what_is_not_symmetric_is_refused(capfd: pytest.CaptureFixture[str]) -> None:
    source = shapes.monkey()
    with pytest.raises(RuntimeError, match="not symmetric at the plane y = "):
        bpy.ops.seamstress.quads(faces=800, symmetry={"Y"})
    assert bpy.context.object is source and not source.hide_get()


def pieces(mesh: bpy.types.Mesh) -> int:
    root = list(range(len(mesh.vertices)))

    def find(a: int) -> int:
        while root[a] != a:
            a = root[a]
        return a

    for edge in mesh.edges:
        a, b = (find(vertex) for vertex in edge.vertices)
        root[max(a, b)] = min(a, b)
    return len({find(vertex) for vertex in range(len(root))})


def test_an_object_changed_meanwhile_stays() -> None:
    from seamstress.reading import Unfit
    from seamstress.targets import Target

    source = shapes.monkey()
    target = Target.of(source)
    assert target.object() is source
    source.data.vertices[0].co.x += 1.0
    with pytest.raises(Unfit, match="Suzanne was changed meanwhile"):
        target.object()
    bpy.data.objects.remove(source)
    with pytest.raises(Unfit, match="Suzanne was removed meanwhile"):
        target.object()
