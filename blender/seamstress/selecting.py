# SPDX-License-Identifier: GPL-3.0-or-later
"""Elements of meshes selected, to be seen in edit mode."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from .reading import Geometry

#: Where Blender keeps what is selected: the attributes and their domains.
SELECTED = {".select_vert": "POINT", ".select_edge": "EDGE", ".select_poly": "FACE"}


def are_edges(geometry: Geometry, pairs: np.ndarray) -> np.ndarray:
    """Whether an edge joins one of these pairs of vertices (e,)."""
    n = len(geometry.positions)

    def keys(ends: np.ndarray) -> np.ndarray:
        ends = np.sort(ends.astype(np.int64), axis=1)
        return ends[:, 0] * n + ends[:, 1]

    return np.isin(keys(geometry.edges), keys(pairs.reshape(-1, 2)))


def select_findings(mesh: bpy.types.Mesh, geometry: Geometry, findings: list[dict[str, Any]]) -> None:
    """Selects the elements of findings and nothing else: edges if one names any, else faces, else vertices."""
    vertices = np.zeros(len(mesh.vertices), bool)
    edges = np.zeros(len(mesh.edges), bool)
    faces = np.zeros(len(mesh.polygons), bool)
    pairs: list[list[int]] = []
    for finding in findings:
        elements = finding.get("elements") or {}
        if elements.get("edges"):
            pairs += elements["edges"]
        elif elements.get("faces"):
            faces[elements["faces"]] = True
        else:
            vertices[elements.get("vertices", [])] = True
    if pairs:
        edges |= are_edges(geometry, np.array(pairs))
    select(mesh, geometry, vertices, edges, faces)


def select(mesh: bpy.types.Mesh, geometry: Geometry, vertices: np.ndarray, edges: np.ndarray, faces: np.ndarray) -> None:
    """Selects elements and nothing else. As Blender has it, edges bring their ends, and faces their edges."""
    edges = edges.copy()
    edges[geometry.corner_edges[np.repeat(faces, geometry.sizes)]] = True
    vertices = vertices.copy()
    vertices[geometry.edges[edges].ravel()] = True
    drop_broken(mesh)
    for (name, domain), chosen in zip(SELECTED.items(), (vertices, edges, faces)):
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "BOOLEAN", domain)
        attribute.data.foreach_set("value", chosen)
    mesh.update()


def drop_broken(mesh: bpy.types.Mesh) -> None:
    """Removes what is selected where it is of a wrong type: Blender 5.0 makes such an attribute together with edges."""
    for name in SELECTED:
        attribute = mesh.attributes.get(name)
        if attribute is not None and attribute.data_type != "BOOLEAN":
            mesh.attributes.remove(attribute)


def select_edges(mesh: bpy.types.Mesh, geometry: Geometry, pairs: list[list[int]]) -> None:
    """Selects the edges between pairs of vertices and nothing else."""
    none = np.zeros(len(mesh.vertices), bool), np.zeros(len(mesh.polygons), bool)
    select(mesh, geometry, none[0], are_edges(geometry, np.array(pairs)), none[1])
