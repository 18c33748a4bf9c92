# SPDX-License-Identifier: GPL-3.0-or-later
"""What artists paint and draw to guide a mesh: sizes by vertex groups and colors, directions by edges and strokes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np
from bpy.app.translations import pgettext_rpt as rpt
from mathutils.bvhtree import BVHTree

from .reading import Geometry, Unfit, edge_source, group_weights, marked_edges, values

#: How far from a mesh strokes may be that guide it, in sizes of the mesh: those farther off are on other objects.
NEAR = 0.05


def sizes(object: bpy.types.Object, mesh: bpy.types.Mesh, settings: Any) -> np.ndarray | None:
    """The relative edge lengths at the vertices (n,) by settings as `settings.QuadSettings`; none if all are alike."""
    if settings.density == "NONE":
        return None
    painted = {"GROUP": painted_weights, "COLOR": painted_colors}[settings.density](object, mesh, settings.density_name)
    return settings.density_ratio ** (0.5 - painted.clip(0.0, 1.0))


def painted_weights(object: bpy.types.Object, mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """The weights of the vertex group of a name, or of the active one."""
    group = object.vertex_groups.get(name) if name else object.vertex_groups.active
    if group is None:
        raise Unfit(rpt("{} has no such vertex group").format(object.name))
    return group_weights(mesh, len(object.vertex_groups))[:, group.index]


def painted_colors(object: bpy.types.Object, mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """The brightness, as it is seen, of the color attribute of a name, or of the active one."""
    colors = mesh.color_attributes.get(name) if name else mesh.color_attributes.active_color
    if colors is None:
        raise Unfit(rpt("{} has no such color attribute").format(object.name))
    brightness = values(colors.data, "color_srgb", 4)[:, :3].mean(axis=1)
    if colors.domain == "POINT":
        return brightness
    corners = values(mesh.loops, "vertex_index", 1, np.int32)
    counts = np.bincount(corners, minlength=len(mesh.vertices))
    return np.bincount(corners, brightness, minlength=len(mesh.vertices)) / np.maximum(counts, 1)


def directions(mesh: bpy.types.Mesh, geometry: Geometry, settings: Any) -> list[str]:
    """Sources of directions as the library has them, by settings as `settings.GuideSettings`: edges, but not strokes."""
    return edge_source(geometry, marked_edges(mesh, geometry, set(settings.guide_marks)))


def strokes(object: bpy.types.Object, geometry: Geometry, settings: Any) -> np.ndarray:
    """Segments of strokes near a mesh (s, 2, 3), by settings as `settings.GuideSettings`."""
    drawn = []
    if "ANNOTATION" in settings.guide_strokes:
        drawn += annotations(bpy.context.scene)
    if "GREASE_PENCIL" in settings.guide_strokes:
        drawn += [line for pencil in bpy.context.visible_objects for line in pencil_strokes(pencil)]
    segments = [np.stack([line[:-1], line[1:]], axis=1) for line in drawn if len(line) > 1]
    if not segments:
        return np.empty((0, 2, 3))
    of_world = np.array(object.matrix_world.inverted(), float)
    placed = (np.concatenate(segments) @ of_world[:3, :3].T + of_world[:3, 3]) @ geometry.linear.T
    return placed[are_near(geometry, placed.mean(axis=1))]


def strokes_text(settings: Any, found: np.ndarray) -> str:
    """That strokes are to be followed but none is near; empty if that is not so."""
    return rpt("no stroke is near it") if settings.guide_strokes and not len(found) else ""


def are_near(geometry: Geometry, points: np.ndarray) -> np.ndarray:
    """Whether points are near a mesh (n,)."""
    polygons = np.split(geometry.corners, np.cumsum(geometry.sizes)[:-1])
    tree = BVHTree.FromPolygons(geometry.positions.tolist(), [polygon.tolist() for polygon in polygons])
    reach = NEAR * float(np.linalg.norm(np.ptp(geometry.positions, axis=0)))
    return np.array([tree.find_nearest(point, reach)[0] is not None for point in points.tolist()], bool)


def annotations(scene: bpy.types.Scene) -> Iterator[np.ndarray]:
    """The visible strokes of the annotations of a scene, in the world (k, 3) each."""
    # They were called so before Blender 5.
    held = scene.annotation if hasattr(scene, "annotation") else scene.grease_pencil
    for layer in held.layers if held is not None else []:
        if layer.annotation_hide or layer.active_frame is None:
            continue
        for stroke in layer.active_frame.strokes:
            # Blender 4.3 and later do not say where they are drawn.
            if getattr(stroke, "display_mode", "3DSPACE") == "3DSPACE":
                yield values(stroke.points, "co", 3).astype(float)


def pencil_strokes(object: bpy.types.Object) -> Iterator[np.ndarray]:
    """The visible strokes of a grease pencil object, in the world (k, 3) each."""
    if object.type == "GPENCIL":
        # Before Blender 4.3.
        for layer in object.data.layers:
            if layer.hide or layer.active_frame is None:
                continue
            for stroke in layer.active_frame.strokes:
                yield moved(values(stroke.points, "co", 3), object.matrix_world @ layer.matrix_layer)
    elif object.type == "GREASEPENCIL" and bpy.app.version >= (4, 3):
        for layer in object.data.layers:
            frame = layer.current_frame()
            if layer.hide or frame is None or not len(frame.drawing.curve_offsets):
                continue
            points = values(frame.drawing.attributes["position"].data, "vector", 3)
            points = moved(points, object.matrix_world @ layer.matrix_local)
            yield from np.split(points, [offset.value for offset in frame.drawing.curve_offsets][1:-1])


def moved(points: np.ndarray, matrix: Any) -> np.ndarray:
    """Points moved by a matrix (4, 4)."""
    matrix = np.array(matrix, float)
    return points @ matrix[:3, :3].T + matrix[:3, 3]
