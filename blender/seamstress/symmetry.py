# SPDX-License-Identifier: GPL-3.0-or-later
"""Symmetric quads: one side of the planes of an object is made, and mirrored."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import bmesh
import bpy
import numpy as np
from bpy.app.translations import pgettext_rpt as rpt

from .carrying import Carried, Part
from .reading import Geometry, Unfit, values

#: How near to a plane vertices are put onto it when the mesh is cut, in sizes of the mesh.
ON_PLANE = 1e-6
#: How near to a plane vertices of quads are the same on both sides, in lengths of edges.
MEETS = 1e-2


@contextmanager
def side_of(mesh: bpy.types.Mesh, axes: list[int]) -> Iterator[bpy.types.Mesh]:
    """The side of a mesh where the coordinates of these axes are positive."""
    if not axes:
        yield mesh
        return
    size = float(np.ptp(values(mesh.vertices, "co", 3), axis=0).max())
    side = mesh.copy()
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        for axis in axes:
            normal = [0.0, 0.0, 0.0]
            normal[axis] = 1.0
            parts = [*edited.verts, *edited.edges, *edited.faces]
            bmesh.ops.bisect_plane(
                edited, geom=parts, dist=size * ON_PLANE, plane_co=(0.0, 0.0, 0.0), plane_no=normal, clear_inner=True
            )
        edited.to_mesh(side)
        if not side.polygons:
            raise Unfit(rpt("{} has no faces on the positive side of its planes of symmetry").format(mesh.name))
        yield side
    finally:
        edited.free()
        bpy.data.meshes.remove(side)


def rim(geometry: Geometry, axes: list[int]) -> np.ndarray:
    """Whether an edge of a side lies in a plane of symmetry (e,)."""
    positions = geometry.to_object(geometry.positions)
    near = np.abs(positions) <= np.ptp(positions, axis=0).max() * ON_PLANE * 2
    return (
        np.any([near[geometry.edges, axis].all(axis=1) for axis in axes], axis=0)
        if axes
        else np.zeros(len(geometry.edges), bool)
    )


@dataclass(frozen=True)
class Quads:
    """Quads as an object has them, with all that they carry."""

    positions: np.ndarray
    faces: np.ndarray
    carried: Carried
    #: The vertex of the side that was made that each vertex is, or is the image of.
    origin: np.ndarray


def mirrored(quads: Quads, axis: int) -> Quads:
    """Both sides of quads that end at the plane across an axis."""
    positions = quads.positions.copy()
    sides = positions[quads.faces] - positions[np.roll(quads.faces, -1, axis=1)]
    is_shared = np.abs(positions[:, axis]) <= MEETS * np.median(np.linalg.norm(sides, axis=2))
    positions[is_shared, axis] = 0.0
    n = len(positions)
    image = np.where(is_shared, np.arange(n), n - 1 + np.cumsum(~is_shared))
    images = positions[~is_shared]
    images[:, axis] *= -1.0

    def both(part: Part) -> Part:
        other = image_of(part, quads.carried.groups, axis)
        if part.on == "vertex":
            other = other[~is_shared]
        elif part.on == "corner":
            other = other[:, ::-1]
        return part.with_values(np.concatenate([part.values, other]))

    return Quads(
        np.vstack([positions, images]),
        np.vstack([quads.faces, image[quads.faces][:, ::-1]]),
        replace(quads.carried, parts=[both(part) for part in quads.carried.parts]),
        np.concatenate([quads.origin, quads.origin[~is_shared]]),
    )


def image_of(part: Part, groups: list[str], axis: int) -> np.ndarray:
    """The values of a part on the other side of the plane across an axis."""
    other = part.values.copy()
    if part.kind in {"key", "normals"}:
        other[..., axis] *= -1.0
    elif part.kind == "groups":
        other = other[:, [groups.index(other_side(name, groups)) for name in groups]]
    return other


def other_side(name: str, names: list[str]) -> str:
    """The vertex group of the other side, such as ``arm.R`` for ``arm.L``, if there is one; else the same."""
    other = bpy.utils.flip_name(name)
    return other if other in names else name
