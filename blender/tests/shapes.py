# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes for tests, and what is measured of them."""

from __future__ import annotations

import bpy
import numpy as np


def added(name: str, vertices: object, faces: object) -> bpy.types.Object:
    """An object of a mesh of these vertices and faces, selected and active."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(vertices, float), [], faces)
    object = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(object)
    select(object)
    return object


def select(*objects: bpy.types.Object) -> None:
    """Selects these objects alone; the first is active."""
    bpy.context.view_layer.update()
    for object in bpy.context.view_layer.objects:
        object.select_set(object in objects)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.context.view_layer.update()


def monkey() -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add()
    return bpy.context.object


def grid(size: int, hole: tuple[int, int, int, int] | None = None) -> bpy.types.Object:
    """A square plane of side 2 with size x size quads, without those from (x, y) up to (x, y)."""
    line = np.linspace(-1.0, 1.0, size + 1)
    vertices = [(x, y, 0.0) for y in line for x in line]
    at = lambda x, y: y * (size + 1) + x  # noqa: E731
    kept = [
        (at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1))
        for y in range(size)
        for x in range(size)
        if hole is None or not (hole[0] <= x < hole[2] and hole[1] <= y < hole[3])
    ]
    used = sorted({vertex for face in kept for vertex in face})
    new = {vertex: i for i, vertex in enumerate(used)}
    return added("Plane", [vertices[v] for v in used], [[new[v] for v in face] for face in kept])


def tube(around: int, rows: int, twist: float) -> bpy.types.Object:
    """An upright tube of radius 1 and length 6, whose rows are turned against each other by a share of a step."""
    vertices = [
        (np.cos(angle), np.sin(angle), 6.0 * row / rows)
        for row in range(rows + 1)
        for angle in 2.0 * np.pi * (np.arange(around) + twist * row) / around
    ]
    below = [(row * around + k, row * around + (k + 1) % around) for row in range(rows) for k in range(around)]
    return added("Tube", vertices, [(a, b, b + around, a + around) for a, b in below])


def cube(cuts: int = 11) -> bpy.types.Object:
    """A cube of side 2 with UVs, cut into (cuts + 1)^2 quads a side; the upper side has another material and its rim is
    creased, sharp, a seam and bevelled.
    """
    bpy.ops.mesh.primitive_cube_add(size=2, calc_uvs=True)
    object = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide(number_cuts=cuts)
    bpy.ops.object.mode_set(mode="OBJECT")
    mesh = object.data
    for name in ("side", "top"):
        mesh.materials.append(bpy.data.materials.new(name))
    for polygon in mesh.polygons:
        polygon.material_index = int(polygon.center.z > 0.999)
    places = positions(mesh)[np.array([edge.vertices[:] for edge in mesh.edges])]
    is_outer = (np.abs(places) > 0.999).all(axis=1)
    on_rim = (places[:, :, 2] > 0.999).all(axis=1) & (is_outer[:, 0] | is_outer[:, 1])
    marks = {"crease_edge": 0.75, "bevel_weight_edge": 0.5, "sharp_edge": True, "uv_seam": True}
    for name, value in marks.items():
        kind = "BOOLEAN" if value is True else "FLOAT"
        mark = mesh.attributes.get(name) or mesh.attributes.new(name, kind, "EDGE")
        mark.data.foreach_set("value", on_rim * value)
    return object


def positions(mesh: bpy.types.Mesh) -> np.ndarray:
    out = np.empty(len(mesh.vertices) * 3, np.float32)
    mesh.vertices.foreach_get("co", out)
    return out.reshape(-1, 3).astype(float)


def world(object: bpy.types.Object) -> np.ndarray:
    """Positions in the world."""
    matrix = np.array(object.matrix_world)
    return positions(object.data) @ matrix[:3, :3].T + matrix[:3, 3]


def areas(mesh: bpy.types.Mesh) -> np.ndarray:
    return np.array([polygon.area for polygon in mesh.polygons])


def edge_length(object: bpy.types.Object, chosen: np.ndarray) -> float:
    """The length of the edges that are chosen."""
    ends = np.array([edge.vertices[:] for edge in object.data.edges])[chosen]
    places = positions(object.data)[ends]
    return float(np.linalg.norm(places[:, 1] - places[:, 0], axis=1).sum())


def attribute(mesh: bpy.types.Mesh, name: str, key: str = "value", n: int = 1) -> np.ndarray:
    data = mesh.attributes[name].data
    out = np.empty(len(data) * n, np.float32)
    data.foreach_get(key, out)
    return out.reshape(-1, n).squeeze().astype(float)


def uv_areas(mesh: bpy.types.Mesh, layer: str) -> np.ndarray:
    """The signed areas of faces in a UV map."""
    uv = attribute(mesh, layer, "vector", 2)
    out = []
    for polygon in mesh.polygons:
        here = uv[list(polygon.loop_indices)]
        there = np.roll(here, -1, axis=0)
        out.append(0.5 * (here[:, 0] * there[:, 1] - here[:, 1] * there[:, 0]).sum())
    return np.array(out)


def border_edges(mesh: bpy.types.Mesh) -> np.ndarray:
    """Whether an edge has one face."""
    faces = np.zeros(len(mesh.edges), int)
    for loop in mesh.loops:
        faces[loop.edge_index] += 1
    return faces == 1


def are_quads(mesh: bpy.types.Mesh) -> bool:
    """Whether a mesh is a manifold of quads."""
    faces = np.zeros(len(mesh.edges), int)
    for loop in mesh.loops:
        faces[loop.edge_index] += 1
    return {polygon.loop_total for polygon in mesh.polygons} == {4} and set(faces) <= {1, 2}
