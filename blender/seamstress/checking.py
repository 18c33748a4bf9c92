# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that says what is wrong with meshes and maps, and shows where."""

from collections import Counter
from typing import Any

import bpy
from bpy.app.translations import pgettext_rpt as rpt
from bpy.props import BoolProperty, FloatProperty

from . import reading
from .reading import Geometry, Unfit
from .running import Running, Task
from .selecting import select_findings
from .summary import PROPERTY, Summary
from .targets import Target


class SEAMSTRESS_OT_check(Running, bpy.types.Operator):
    """Check whether the selected meshes are oriented manifolds, and whether their active UV map is seamless; select what \
is wrong in edit mode"""

    bl_idname = "seamstress.check"
    bl_label = "Check"
    bl_options = {"REGISTER", "UNDO"}

    use_map: BoolProperty(name="UV Map", description="Check whether the active UV map is seamless", default=True)
    tolerance: FloatProperty(
        name="Tolerance",
        description="How far the sides of a seam may be apart, in lengths of the edge. UV maps have few digits",
        default=1e-4,
        min=1e-9,
        max=1e-2,
        precision=6,
    )

    def task(self, context: bpy.types.Context, objects: list[bpy.types.Object]) -> Task:
        object = objects[0]
        mesh = object.data
        if not mesh.polygons:
            raise Unfit(rpt("{} has no faces").format(object.name))
        geometry = reading.read(mesh, reading.linear_part(object))
        layer = mesh.uv_layers.active if self.use_map else None
        uv = None if layer is None else reading.values(layer.uv, "vector", 2).astype(float)
        arguments = {"mesh": geometry.arrays(), "uv": uv, "tolerance": self.tolerance}
        target = Target.of(object)
        return Task(object.name, "check", arguments, lambda result: self._show(target.object(), geometry, result))

    def end(self, context: bpy.types.Context) -> None:
        """Goes into edit mode if there is something to see."""
        # What is in collections alone can be selected, but not shown.
        found = [object for object in getattr(self, "_found", []) if object.name in context.view_layer.objects]
        super().end(context)
        if found and context.mode == "OBJECT":
            for object in context.view_layer.objects:
                object.select_set(object in found)
            context.view_layer.objects.active = found[0]
            bpy.ops.object.mode_set(mode="EDIT")
        self._found = []

    def _show(self, object: bpy.types.Object, geometry: Geometry, result: dict[str, Any]) -> str:
        mesh = object.data
        findings, report = result["findings"], result["report"]
        if report is not None and report["certified"]:
            summary = Summary.of_map(report)
            summary.store(mesh)
            return f"{summary.title}, {summary.text()}"
        if PROPERTY in mesh:
            del mesh[PROPERTY]
        if not findings:
            if result["message"] is not None:
                raise Unfit(result["message"])
            return rpt("an oriented manifold")
        select_findings(mesh, geometry, findings)
        self._found = [*getattr(self, "_found", []), object]
        kinds = Counter(finding["kind"] for finding in findings)
        named = ", ".join(f"{count} {kind.replace('-', ' ')}" for kind, count in kinds.most_common())
        what = rpt("the UV map is not seamless") if report is not None else rpt("not an oriented manifold")
        if all(finding["severity"] == "warning" for finding in findings):
            what = rpt("an oriented manifold, with remarks")
        return f"{what}: {named}"
