# SPDX-License-Identifier: GPL-3.0-or-later
"""Density and directions that are painted, marked and drawn."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np
import pytest
import shapes
from seamstress import guiding, settings

PLAIN = {"creases": "NONE", "marks": set(), "use_boundary": False}


def quads(**chosen: object) -> bpy.types.Object:
    assert bpy.ops.seamstress.quads(**chosen) == {"FINISHED"}
    return bpy.context.object


def edges(object: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """Middles and vectors of edges in the world."""
    ends = shapes.world(object)[np.array([edge.vertices[:] for edge in object.data.edges])]
    return ends.mean(axis=1), ends[:, 1] - ends[:, 0]


def mean_edge(object: bpy.types.Object, is_there: Callable[[np.ndarray], np.ndarray]) -> float:
    middles, along = edges(object)
    return float(np.linalg.norm(along, axis=1)[is_there(middles)].mean())


def off_from(object: bpy.types.Object, degrees: float) -> float:
    """Mean angle between the edges of quads in a plane and a direction, or the one at right angles to it."""
    _, along = edges(object)
    angles = (np.degrees(np.arctan2(along[:, 1], along[:, 0])) - degrees) % 90.0
    return float(np.minimum(angles, 90.0 - angles).mean())


def paint_group(source: bpy.types.Object, values: np.ndarray) -> None:
    group = source.vertex_groups.new(name="paint")
    for vertex, value in enumerate(values):
        group.add([vertex], float(value), "REPLACE")


def paint_points(source: bpy.types.Object, values: np.ndarray) -> None:
    colors = np.column_stack([values, values, values, np.ones(len(values))])
    layer = source.data.color_attributes.new("paint", "FLOAT_COLOR", "POINT")
    layer.data.foreach_set("color", colors.astype(np.float32).ravel())


def paint_corners(source: bpy.types.Object, values: np.ndarray) -> None:
    layer = source.data.color_attributes.new("paint", "BYTE_COLOR", "CORNER")
    of_corners = values[[loop.vertex_index for loop in source.data.loops]]
    colors = np.column_stack([of_corners, of_corners, of_corners, np.ones(len(of_corners))])
    layer.data.foreach_set("color", colors.astype(np.float32).ravel())


@pytest.mark.parametrize("name", ["paint", ""])
@pytest.mark.parametrize(("kind", "paint"), [("GROUP", paint_group), ("COLOR", paint_points), ("COLOR", paint_corners)])
def test_quads_are_smaller_where_it_is_painted(kind: str, paint: Callable, name: str) -> None:
    source = shapes.grid(24)
    paint(source, (shapes.positions(source.data)[:, 0] > 0.0).astype(float))
    made = quads(faces=800, density=kind, density_name=name, density_ratio=3.0)
    assert 720 <= len(made.data.polygons) <= 880
    coarse, fine = (mean_edge(made, lambda at, side=side: side * at[:, 0] > 0.5) for side in (-1.0, 1.0))
    assert 2.4 < coarse / fine < 3.3


def test_brightness_is_that_which_is_seen() -> None:
    source = shapes.grid(2)
    paint_points(source, np.full(9, 0.2140411))
    wanted = guiding.sizes(source, source.data, settings_of(density="COLOR", density_ratio=5.0))
    assert np.allclose(wanted, 1.0, atol=1e-3)


def settings_of(**chosen: object) -> bpy.types.PropertyGroup:
    held = bpy.context.scene.seamstress.quads
    for name, value in chosen.items():
        setattr(held, name, value)
    return held


def test_what_is_painted_counts_on_both_sides_of_symmetry() -> None:
    source = shapes.grid(24)
    places = shapes.positions(source.data)
    paint_group(source, ((places[:, 0] < 0.0) & (places[:, 1] > 0.0)).astype(float))
    made = quads(faces=800, density="GROUP", density_ratio=3.0, symmetry={"X"})
    found = {tuple(place) for place in shapes.positions(made.data) + 0.0}
    assert found == {(-x + 0.0, y, z) for x, y, z in found}
    assert mean_edge(made, lambda at: at[:, 1] < -0.5) > 2.0 * mean_edge(made, lambda at: at[:, 1] > 0.5)


def test_what_is_not_painted_is_named() -> None:
    shapes.grid(4)
    with pytest.raises(RuntimeError, match="Plane has no such vertex group"):
        bpy.ops.seamstress.quads(density="GROUP")
    with pytest.raises(RuntimeError, match="Plane has no such color attribute"):
        bpy.ops.seamstress.quads(density="COLOR", density_name="paint")


def test_quads_adapt_to_curvature() -> None:
    """A ball with a flattened top and bottom bends at its rim."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48)
    source = bpy.context.object
    source.scale = (1.0, 1.0, 0.2)
    bpy.context.view_layer.update()
    made = quads(faces=1500, adaptive=1.0)
    assert 1350 <= len(made.data.polygons) <= 1650
    rim = mean_edge(made, lambda at: np.linalg.norm(at[:, :2], axis=1) > 0.95)
    top = mean_edge(made, lambda at: np.linalg.norm(at[:, :2], axis=1) < 0.5)
    assert rim < 0.7 * top


def test_marked_edges_are_guides_without_lines_along_them() -> None:
    plane = shapes.grid(16).data
    halves = [half for a, b, c, d in (face.vertices for face in plane.polygons) for half in ((a, b, c), (a, c, d))]
    source = shapes.added("Triangles", shapes.positions(plane), halves)
    _, along = edges(source)
    source.data.edges.foreach_set("use_seam", along[:, 0] * along[:, 1] > 1e-4)
    assert off_from(quads(faces=200, guide_marks={"SEAM"}, **PLAIN), 45.0) < 2.0


def lines(turn: float) -> np.ndarray:
    """Three strokes (3, 20, 3) at an angle in a plane somewhat above the ground."""
    way = np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn))])
    steps = np.linspace(-0.8, 0.8, 20)[:, None] * way
    flat = np.stack([steps + shift * way[::-1] * [-1.0, 1.0] for shift in (-0.5, 0.0, 0.5)])
    return np.concatenate([flat, np.full((3, 20, 1), 0.01)], axis=2)


def annotated(strokes: np.ndarray) -> bpy.types.ID:
    """Annotations as they are drawn in the 3D view, which alone makes strokes in every version; then put in their place."""
    scene = bpy.context.scene
    new = bpy.data.annotations if hasattr(scene, "annotation") else bpy.data.grease_pencils
    setattr(scene, "annotation" if hasattr(scene, "annotation") else "grease_pencil", held := new.new("Notes"))
    layer = held.layers.new("Guides")
    fields = [field for field in bpy.types.OperatorStrokeElement.bl_rna.properties if field.identifier != "rna_type"]
    plain = {f.identifier: list(f.default_array) if getattr(f, "is_array", False) else f.default for f in fields}
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        for stroke in strokes:
            places = [(400.0 + 20.0 * k, 400.0) for k in range(len(stroke))]
            mouse = [{**plain, "mouse": at, "mouse_event": at, "is_start": k == 0} for k, at in enumerate(places)]
            bpy.ops.gpencil.annotate("EXEC_DEFAULT", mode="DRAW", stroke=mouse)
    for drawn, stroke in zip(layer.active_frame.strokes, strokes, strict=True):
        drawn.points.foreach_set("co", stroke.astype(np.float32).ravel())
    return held


def pencilled(strokes: np.ndarray) -> bpy.types.Object:
    """A grease pencil object, twice as large as its strokes are told."""
    if bpy.app.version < (4, 3):
        bpy.ops.object.gpencil_add(type="EMPTY")
        frame = bpy.context.object.data.layers.new("Guides").frames.new(1)
        for stroke in strokes:
            drawn = frame.strokes.new()
            drawn.points.add(len(stroke))
            drawn.points.foreach_set("co", 0.5 * stroke.astype(np.float32).ravel())
        bpy.context.scene.frame_set(1)
    else:
        bpy.ops.object.grease_pencil_add(type="EMPTY")
        drawing = bpy.context.object.data.layers.new("Guides").frames.new(1).drawing
        drawing.add_strokes([len(stroke) for stroke in strokes])
        drawing.attributes["position"].data.foreach_set("vector", 0.5 * strokes.astype(np.float32).ravel())
    made = bpy.context.object
    made.scale = (2.0, 2.0, 2.0)
    return made


def kept(drawn: bpy.types.ID) -> None:
    """Strokes that are shown."""


def hidden(drawn: bpy.types.ID) -> None:
    """Those of hidden layers."""
    is_pencil = isinstance(drawn, bpy.types.Object)
    for layer in (drawn.data if is_pencil else drawn).layers:
        setattr(layer, "hide" if is_pencil else "annotation_hide", True)


@pytest.mark.parametrize(("change", "is_followed"), [(kept, True), (hidden, False)])
@pytest.mark.parametrize(("draw", "name"), [(annotated, "ANNOTATION"), (pencilled, "GREASE_PENCIL")])
def test_strokes_are_followed(draw: Callable, name: str, change: Callable, is_followed: bool) -> None:
    source = shapes.grid(16)
    source.location = (3.0, 1.0, 0.5)
    change(draw(lines(30.0) + [3.0, 1.0, 0.5]))
    shapes.select(source)
    made = quads(faces=200, guide_strokes={name}, **PLAIN)
    assert (off_from(made, 30.0) < 3.0) == is_followed


def test_strokes_far_away_do_not_count(capfd: pytest.CaptureFixture[str]) -> None:
    source = shapes.grid(16)
    annotated(lines(30.0) + [0.0, 0.0, 1.0])
    shapes.select(source)
    made = quads(faces=200, guide_strokes={"ANNOTATION"}, **PLAIN)
    assert off_from(made, 30.0) > 10.0
    assert "no stroke is near it" in capfd.readouterr().out


def test_strokes_are_placed_by_the_object() -> None:
    """Turned, scaled unevenly and moved, with the settings of symmetry and without."""
    source = shapes.grid(4)
    source.location, source.rotation_euler, source.scale = (1.0, 2.0, 3.0), (0.2, 0.3, 0.4), (1.0, 2.0, 1.0)
    bpy.context.view_layer.update()
    flat = lines(20.0) * [1.0, 1.0, 0.0]
    matrix = np.array(source.matrix_world)
    annotated(flat @ matrix[:3, :3].T + matrix[:3, 3])
    from seamstress import reading

    for linear in (reading.linear_part(source), reading.scale_part(source)):
        geometry = reading.read(source.data, linear)
        found = guiding.strokes(source, geometry, settings_of(guide_strokes={"ANNOTATION"}))
        wanted = np.stack([flat[:, :-1], flat[:, 1:]], axis=2).reshape(-1, 2, 3) @ linear.T
        assert np.allclose(found, wanted, atol=1e-5)


def test_maps_follow_strokes() -> None:
    """The grid of a map lies along them: its checks are turned by as much."""
    source = shapes.grid(16)
    annotated(lines(30.0))
    shapes.select(source)
    assert bpy.ops.seamstress.seamless_uv(guide_strokes={"ANNOTATION"}) == {"FINISHED"}
    uv = shapes.attribute(source.data, "Seamless", "vector", 2)
    polygon = source.data.polygons[100]
    here = uv[list(polygon.loop_indices)]
    turn = np.degrees(np.arctan2(*(here[1] - here[0])[::-1])) % 90.0
    assert abs(turn - 60.0) < 3.0


def test_settings_are_for_quads_and_maps() -> None:
    of_maps = set(settings.names(settings.MapSettings))
    assert {"align", "guide_marks", "guide_strokes"} <= of_maps and "adaptive" not in of_maps
