# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that are worked on, found again when the work is done: meanwhile anything may have happened to them."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.app.translations import pgettext_rpt as rpt

from .reading import Unfit, values


@dataclass(frozen=True)
class Target:
    """An object as it was when the work began."""

    name: str
    id: int
    fingerprint: int

    @classmethod
    def of(cls, object: bpy.types.Object) -> Target:
        """An object as it is now."""
        return cls(object.name, object.session_uid, fingerprint(object.data))

    def object(self) -> bpy.types.Object:
        """The object. Raises ``Unfit`` if it is gone, or its mesh is another."""
        found = next((object for object in bpy.data.objects if object.session_uid == self.id), None)
        if found is None:
            raise Unfit(rpt("{} was removed meanwhile").format(self.name))
        if found.mode != "OBJECT" or fingerprint(found.data) != self.fingerprint:
            raise Unfit(rpt("{} was changed meanwhile; it stays as it is").format(self.name))
        return found


def fingerprint(mesh: bpy.types.Mesh) -> int:
    """A number that changes when the geometry of a mesh does."""
    corners = values(mesh.loops, "vertex_index", 1, np.int32)
    return zlib.crc32(corners.tobytes(), zlib.crc32(values(mesh.vertices, "co", 3).tobytes()))
