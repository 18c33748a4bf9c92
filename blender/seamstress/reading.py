# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of Blender as arrays."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from bpy.app.translations import pgettext_rpt as rpt

#: Edges that are marked, by the names of the settings; see `settings.MARKS`.
EDGE_MARKS = {"SHARP": "sharp_edge", "CREASE": "crease_edge", "BEVEL": "bevel_weight_edge", "SEAM": "uv_seam"}
#: Faces whose borders are marks.
FACE_MARKS = {"MATERIAL": "material_index", "FACE_SET": ".sculpt_face_set"}
#: Values smaller than this are no mark.
UNMARKED = 1e-3
#: How small a scale along an axis may be against the largest: below, the object is flat.
FLAT = 1e-6


class Unfit(Exception):
    """Why an object cannot be worked on, for people."""


@dataclass(frozen=True)
class Geometry:
    """Positions at the scale of the world, and polygons."""

    #: Positions (n, 3): turned and scaled as the object is, but not moved.
    positions: np.ndarray
    #: Numbers of corners of the polygons (m,).
    sizes: np.ndarray
    #: Vertices of the corners (k,).
    corners: np.ndarray
    #: Ends of the edges (e, 2), and whether each has a face (e,).
    edges: np.ndarray
    is_used: np.ndarray
    #: The edge after each corner (k,).
    corner_edges: np.ndarray
    #: Turns and scales what the object has into what the world has, (3, 3).
    linear: np.ndarray

    def arrays(self) -> dict[str, np.ndarray]:
        """What the worker makes a surface of."""
        return {"positions": self.positions, "sizes": self.sizes, "corners": self.corners}

    def to_object(self, positions: np.ndarray) -> np.ndarray:
        """Positions as the object has them."""
        return positions @ np.linalg.inv(self.linear).T


def values(collection: Any, name: str, n: int, dtype: type = np.float32) -> np.ndarray:
    """A property of all elements of a collection, with ``n`` numbers each."""
    out = np.empty(len(collection) * n, dtype)
    collection.foreach_get(name, out)
    return out.reshape(-1, n) if n > 1 else out


def linear_part(object: bpy.types.Object) -> np.ndarray:
    """What turns and scales an object in the world, (3, 3)."""
    linear = np.array(object.matrix_world.to_3x3(), float)
    scales = np.linalg.svd(linear, compute_uv=False)
    if not scales[-1] > FLAT * scales[0]:
        raise Unfit(rpt("{} has a scale of zero along an axis").format(object.name))
    return linear


def scale_part(object: bpy.types.Object) -> np.ndarray:
    """What scales an object in the world along its own axes, (3, 3): planes across its axes stay such planes."""
    return np.diag(np.linalg.norm(linear_part(object), axis=0))


def require_own(*data: bpy.types.ID) -> None:
    """Raises ``Unfit`` if something that is to be changed belongs to another file."""
    for one in data:
        if one.library is not None:
            raise Unfit(rpt("{} is linked from another file; make it local first").format(one.name))


@contextmanager
def mesh_of(context: bpy.types.Context, object: bpy.types.Object, apply_modifiers: bool) -> Iterator[bpy.types.Mesh]:
    """The mesh of an object, with its modifiers applied if that is asked for."""
    object.update_from_editmode()
    if not (apply_modifiers and has_modifiers(object)):
        yield object.data
        return
    depsgraph = context.evaluated_depsgraph_get()
    evaluated = object.evaluated_get(depsgraph)
    mesh = bpy.data.meshes.new_from_object(evaluated, preserve_all_data_layers=True, depsgraph=depsgraph)
    try:
        yield mesh
    finally:
        bpy.data.meshes.remove(mesh)


def has_modifiers(object: bpy.types.Object) -> bool:
    """Whether modifiers change what is shown of an object."""
    return any(modifier.show_viewport for modifier in object.modifiers)


def read(mesh: bpy.types.Mesh, linear: np.ndarray) -> Geometry:
    """The geometry of a mesh. Of a mesh with shape keys it is their reference."""
    keys = mesh.shape_keys
    if keys is not None and len(keys.reference_key.data) == len(mesh.vertices):
        positions = values(keys.reference_key.data, "co", 3)
    else:
        positions = values(mesh.vertices, "co", 3)
    positions = positions.astype(float)
    if not np.array_equal(linear, np.eye(3)):
        positions = positions @ linear.T
    corner_edges = values(mesh.loops, "edge_index", 1, np.int32)
    return Geometry(
        positions,
        values(mesh.polygons, "loop_total", 1, np.int32),
        values(mesh.loops, "vertex_index", 1, np.int32),
        values(mesh.edges, "vertices", 2, np.int32),
        np.bincount(corner_edges, minlength=len(mesh.edges)) > 0,
        corner_edges,
        linear,
    )


def edge_values(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """An attribute of edges as numbers; zero where there is none."""
    # Seams have the name of a hidden attribute before Blender 4.5.
    attribute = mesh.attributes.get(name) or mesh.attributes.get("." + name)
    if attribute is None or attribute.domain != "EDGE" or attribute.data_type not in {"FLOAT", "BOOLEAN", "INT"}:
        return np.zeros(len(mesh.edges), np.float32)
    dtype = {"FLOAT": np.float32, "BOOLEAN": bool, "INT": np.int32}[attribute.data_type]
    return values(attribute.data, "value", 1, dtype).astype(np.float32)


def marked_edges(mesh: bpy.types.Mesh, geometry: Geometry, marks: set[str]) -> np.ndarray:
    """Whether an edge is marked in one of these ways (e,)."""
    is_marked = np.zeros(len(mesh.edges), bool)
    for mark in marks & EDGE_MARKS.keys():
        is_marked |= edge_values(mesh, EDGE_MARKS[mark]) > UNMARKED
    for mark in marks & FACE_MARKS.keys():
        attribute = mesh.attributes.get(FACE_MARKS[mark])
        if attribute is not None and attribute.domain == "FACE":
            is_marked |= is_border(geometry, values(attribute.data, "value", 1, np.int32))
    return is_marked & geometry.is_used


def is_border(geometry: Geometry, labels: np.ndarray) -> np.ndarray:
    """Whether faces of different labels meet at an edge (e,)."""
    of_corner = np.repeat(labels, geometry.sizes)
    lowest = np.full(len(geometry.edges), np.iinfo(np.int32).max, np.int32)
    highest = np.full(len(geometry.edges), np.iinfo(np.int32).min, np.int32)
    np.minimum.at(lowest, geometry.corner_edges, of_corner)
    np.maximum.at(highest, geometry.corner_edges, of_corner)
    return lowest < highest


def feature_sources(mesh: bpy.types.Mesh, geometry: Geometry, settings: Any) -> list[str]:
    """Sources of features as the library has them, by settings as `settings.FeatureSettings`."""
    sources = []
    if settings.creases == "AUTO":
        sources.append("auto")
    elif settings.creases == "ANGLE":
        sources.append(f"angle:{np.degrees(settings.angle)}")
    if settings.use_boundary:
        sources.append("boundary")
    return sources + edge_source(geometry, marked_edges(mesh, geometry, set(settings.marks)))


def edge_source(geometry: Geometry, is_chosen: np.ndarray) -> list[str]:
    """The source of edges as the library has it; none if no edge is chosen."""
    pairs = [f"{a}-{b}" for a, b in geometry.edges[is_chosen]]
    return ["edges:" + ",".join(pairs)] if pairs else []


def group_weights(mesh: bpy.types.Mesh, n: int) -> np.ndarray:
    """The weights of all vertex groups of an object that has so many (vertices, n)."""
    weights = np.zeros((len(mesh.vertices), n))
    for vertex in mesh.vertices:
        for group in vertex.groups:
            if group.group < n:
                weights[vertex.index, group.group] = group.weight
    return weights
