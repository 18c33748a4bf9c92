# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mesh carries beside its geometry, taken over to quads.

Values of vertices, corners and faces are taken over by the library; marks of edges go to the edges that lie along them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np
from mathutils.kdtree import KDTree

from .reading import Geometry, group_weights, values

#: Types of attributes: the property of an element, how many numbers it has, and of what kind. The library mixes real
#: numbers, and takes others for labels.
TYPES = {
    "FLOAT": ("value", 1, np.float32),
    "INT": ("value", 1, np.int32),
    "INT8": ("value", 1, np.int32),
    "BOOLEAN": ("value", 1, bool),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color", 4, np.float32),
}
#: Blender's domains by the library's names.
DOMAINS = {"POINT": "vertex", "CORNER": "corner", "FACE": "face"}
#: Attributes that belong to the geometry itself, or that Blender keeps in another way.
OWN = {"position", "custom_normal"}
#: Attributes with a name of Blender's own that are taken over all the same.
HIDDEN = {".sculpt_face_set"}
#: Settings of shape keys that are kept.
KEY_SETTINGS = ("value", "slider_min", "slider_max", "mute", "interpolation", "vertex_group")
#: Weights of vertex groups below this are left out.
LEAST_WEIGHT = 1e-4
#: An edge of a quad lies along marked edges if it is nowhere farther from them than this share of its length.
BESIDE = 0.15
#: How many points along an edge are compared.
SAMPLES = 5
#: How many points stand for all marked edges, at most about.
MOST_POINTS = 1_000_000


@dataclass(frozen=True)
class Part:
    """Something that a mesh carries, and its values: a row for each vertex, corner or face."""

    #: What it is: ``attribute``, ``groups``, ``key`` or ``normals``.
    kind: str
    #: On what it is, by the library's names.
    on: str
    values: np.ndarray
    name: str = ""
    #: Blender's type of an attribute.
    type: str = ""

    def with_values(self, values: np.ndarray) -> Part:
        """The same of another mesh."""
        return Part(self.kind, self.on, values, self.name, self.type)


@dataclass(frozen=True)
class Key:
    """A shape key: its settings."""

    name: str
    settings: dict[str, Any]
    relative_to: str


@dataclass
class Carried:
    """What a mesh carries, as arrays and plain values."""

    parts: list[Part] = field(default_factory=list)
    #: Names of vertex groups, and shape keys, in the order of their parts.
    groups: list[str] = field(default_factory=list)
    keys: list[Key] = field(default_factory=list)
    #: Attributes of edges: name, type, and value of each.
    edges: list[tuple[str, str, np.ndarray]] = field(default_factory=list)
    #: Attributes that cannot be taken over.
    left_out: list[str] = field(default_factory=list)


def is_carried(attribute: bpy.types.Attribute) -> bool:
    """Whether an attribute is the artist's, rather than part of the geometry."""
    name = attribute.name
    return name not in OWN and (not name.startswith(".") or name in HIDDEN)


def gather(object: bpy.types.Object, mesh: bpy.types.Mesh) -> Carried:
    """All that a mesh carries."""
    carried = Carried()
    for attribute in filter(is_carried, mesh.attributes):
        domain, type = attribute.domain, attribute.data_type
        property, n, dtype = TYPES.get(type, ("", 0, float))
        if n == 0 or (domain == "EDGE" and n > 1):
            carried.left_out.append(attribute.name)
        elif domain == "EDGE":
            carried.edges.append((attribute.name, type, values(attribute.data, property, n, dtype).astype(float)))
        else:
            read = values(attribute.data, property, n, dtype)
            carried.parts.append(Part("attribute", DOMAINS[domain], read, attribute.name, type))
    carried.groups = [group.name for group in object.vertex_groups]
    if carried.groups:
        carried.parts.append(Part("groups", "vertex", group_weights(mesh, len(carried.groups))))
    keys = mesh.shape_keys
    if keys is not None:
        reference = values(keys.reference_key.data, "co", 3).astype(float)
        for block in keys.key_blocks:
            settings = {name: getattr(block, name) for name in KEY_SETTINGS}
            carried.keys.append(Key(block.name, settings, block.relative_key.name))
            carried.parts.append(Part("key", "vertex", values(block.data, "co", 3) - reference, block.name))
    if mesh.has_custom_normals:
        carried.parts.append(Part("normals", "corner", values(mesh.corner_normals, "vector", 3)))
    return carried


def marks_along(carried: Carried, geometry: Geometry, positions: np.ndarray, edges: np.ndarray) -> list[np.ndarray]:
    """The marks of each of the edges (e, 2) between positions, for each attribute of edges; zero off marked edges."""
    beside: dict[bytes, np.ndarray] = {}
    marks = []
    for _, _, of_edges in carried.edges:
        is_marked = (of_edges != 0.0) & geometry.is_used
        key = is_marked.tobytes()
        if key not in beside:
            beside[key] = edges_beside(geometry, np.flatnonzero(is_marked), positions, edges)
        found = beside[key]
        marks.append(np.where(found[:, 0] < 0, 0.0, np.median(of_edges[found], axis=1)))
    return marks


def edges_beside(geometry: Geometry, marked: np.ndarray, positions: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """The marked edges nearest to points along each edge (e, SAMPLES) that lies along marked ones; -1 for the others."""
    out = np.full((len(edges), SAMPLES), -1)
    if not len(marked):
        return out
    lengths = np.linalg.norm(positions[edges[:, 1]] - positions[edges[:, 0]], axis=1)
    ends = geometry.positions[geometry.edges[marked]]
    marked_lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    spacing = max(np.median(lengths) * BESIDE, marked_lengths.sum() / MOST_POINTS)
    counts = np.maximum(np.ceil(marked_lengths / spacing).astype(int), 1) + 1
    tree = KDTree(int(counts.sum()))
    for edge, (a, b), count in zip(marked, ends, counts):
        for point in np.linspace(a, b, count):
            tree.insert(point, int(edge))
    tree.balance()
    # The middle first: most edges are far from any mark there.
    shares = sorted(np.linspace(0.1, 0.9, SAMPLES), key=lambda share: abs(share - 0.5))
    a, b = positions[edges[:, 0]], positions[edges[:, 1]]
    points = np.stack([a + (b - a) * share for share in shares], axis=1).tolist()
    for at, near in enumerate(lengths * BESIDE + spacing / 2.0):
        found = []
        for point in points[at]:
            _, edge, away = tree.find(point)
            if away > near:
                break
            found.append(edge)
        if len(found) == SAMPLES:
            out[at] = found
    return out


def put(carried: Carried, marks: list[np.ndarray], mesh: bpy.types.Mesh) -> None:
    """Gives a mesh of quads its attributes and the marks of its edges. Its vertex groups and shape keys are its object's to
    make.
    """
    for part in carried.parts:
        if part.kind == "attribute":
            give(mesh, part.name, part.type, part.on, part.values)
    for (name, type, _), of_edges in zip(carried.edges, marks):
        if of_edges.any():
            give(mesh, name, type, "edge", of_edges)
    for part in carried.parts:
        if part.kind == "normals":
            normals = part.values.reshape(-1, 3)
            mesh.normals_split_custom_set(normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-12)[:, None])


def keep_choices(old: bpy.types.Mesh, mesh: bpy.types.Mesh) -> None:
    """Gives a mesh what is chosen of another: active layers, and custom properties."""
    for layer in old.uv_layers:
        if (same := mesh.uv_layers.get(layer.name)) is not None:
            same.active = same.active or layer.active
            same.active_render = same.active_render or layer.active_render
    for which in ("active_color_index", "render_color_index"):
        index = getattr(old.color_attributes, which)
        if 0 <= index < len(old.color_attributes):
            setattr(mesh.color_attributes, which, mesh.color_attributes.find(old.color_attributes[index].name))
    for name in old.keys():
        mesh[name] = old[name]


def give(mesh: bpy.types.Mesh, name: str, type: str, on: str, new: np.ndarray) -> None:
    """Gives a mesh an attribute."""
    property, _, dtype = TYPES[type]
    domain = {"edge": "EDGE", **{ours: theirs for theirs, ours in DOMAINS.items()}}[on]
    attribute = mesh.attributes.get(name) or mesh.attributes.new(name, type, domain)
    attribute.data.foreach_set(property, new.astype(dtype).ravel())


def give_groups(carried: Carried, object: bpy.types.Object) -> None:
    """Makes the vertex groups of an object."""
    for weights in (part.values.clip(0.0, 1.0).round(5) for part in carried.parts if part.kind == "groups"):
        for name, column in zip(carried.groups, weights.T):
            group = object.vertex_groups.get(name) or object.vertex_groups.new(name=name)
            found, which = np.unique(column, return_inverse=True)
            order = np.argsort(which, kind="stable")
            parts = np.split(order, np.cumsum(np.bincount(which))[:-1])
            for weight, vertices in zip(found, parts):
                if weight > LEAST_WEIGHT:
                    group.add(vertices.tolist(), float(weight), "REPLACE")


def give_keys(carried: Carried, object: bpy.types.Object, positions: np.ndarray) -> None:
    """Makes the shape keys of an object, of positions as the object has them."""
    blocks = {}
    offsets = [part.values for part in carried.parts if part.kind == "key"]
    for key, moved in zip(carried.keys, offsets):
        block = object.shape_key_add(name=key.name, from_mix=False)
        block.data.foreach_set("co", (positions + moved).astype(np.float32).ravel())
        for name, value in key.settings.items():
            setattr(block, name, value)
        blocks[key.name] = block
    for key in carried.keys:
        blocks[key.name].relative_key = blocks[key.relative_to]
