# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that makes quad meshes."""

from dataclasses import replace
from typing import Any

import bpy
import numpy as np
from bpy.app.translations import pgettext_rpt as rpt

from . import carrying, guiding, reading, settings
from .carrying import Carried
from .reading import Geometry, Unfit
from .running import Running, Task
from .selecting import drop_broken, select_edges
from .summary import Summary, dropped_edges, dropped_text, repairs_text
from .targets import Target


class SEAMSTRESS_OT_quads(settings.QuadSettings, Running, bpy.types.Operator):
    """Make quad meshes of the selected meshes, which follow their creases and keep their materials, UV maps and other \
attributes. Runs beside Blender; Esc stops it"""

    bl_idname = "seamstress.quads"
    bl_label = "Quad Remesh"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    def draw(self, context: bpy.types.Context) -> None:
        from .panel import draw_quads

        draw_quads(self.layout, self)

    def result_of(self, object: bpy.types.Object) -> Any:
        return object if self._applies(object) else object.data

    def _applies(self, object: bpy.types.Object) -> bool:
        return self.use_modifiers and reading.has_modifiers(object)

    def task(self, context: bpy.types.Context, objects: list[bpy.types.Object]) -> Task:
        object = objects[0]
        if self.original == "REPLACE":
            reading.require_own(*objects)
        axes = "".join(sorted(self.symmetry)).lower()
        linear = reading.scale_part(object) if axes else reading.linear_part(object)
        with reading.mesh_of(context, object, self.use_modifiers) as mesh:
            if not mesh.polygons:
                raise Unfit(rpt("{} has no faces").format(object.name))
            geometry = reading.read(mesh, linear)
            carried = carrying.gather(object, mesh) if self.use_attributes else Carried()
            options = {
                "features": reading.feature_sources(mesh, geometry, self) or ["none"],
                "symmetry": axes or "none",
                "align": self.align,
                "directions": guiding.directions(mesh, geometry, self),
                "adaptive": self.adaptive,
                "smooth": self.smooth,
                "cone_bias": self.cone_bias,
                **self._size(len(mesh.polygons)),
            }
            sizes = guiding.sizes(object, mesh, self)
        strokes = guiding.strokes(object, geometry, self)
        arguments = {
            "mesh": geometry.arrays(),
            "sizes": sizes,
            "strokes": strokes,
            "repair": self.use_repair,
            "options": options,
            "values": [(part.on, part.values) for part in carried.parts],
        }
        targets = [Target.of(object) for object in objects]
        applies = self._applies(object)

        def finish(result: dict[str, Any]) -> str:
            found = [target.object() for target in targets]
            text = self._finish_objects(found, applies, geometry, carried, result)
            return "; ".join(filter(None, [text, guiding.strokes_text(self, strokes)]))

        return Task(object.name, "quads", arguments, finish)

    def _size(self, faces: int) -> dict[str, float]:
        if self.target == "EDGE":
            return {"edge_length": self.edge_length}
        quads = self.faces if self.target == "FACES" else faces * self.ratio
        return {"quads": max(quads, 1.0)}

    def _finish_objects(
        self,
        objects: list[bpy.types.Object],
        applies: bool,
        geometry: Geometry,
        carried: Carried,
        result: dict[str, Any],
    ) -> str:
        parts = [part.with_values(values) for part, values in zip(carried.parts, result["values"])]
        positions = geometry.to_object(result["vertices"])
        made = replace(carried, parts=parts)
        old = objects[0].data
        has_keys = old.shape_keys is not None
        mesh = bpy.data.meshes.new(old.name)
        mesh.from_pydata(positions, [], result["quads"], shade_flat=not self.use_attributes)
        drop_broken(mesh)
        for material in old.materials:
            mesh.materials.append(material)
        edges = reading.values(mesh.edges, "vertices", 2, np.int32)
        marks = carrying.marks_along(carried, geometry, result["vertices"], edges)
        carrying.put(made, marks, mesh)
        if self.use_attributes:
            carrying.keep_choices(old, mesh)
        summary = Summary.of_quads(mesh, result["report"])
        summary.store(mesh)
        dropped = [] if applies else dropped_edges(result["report"])
        if dropped:
            select_edges(old, geometry, dropped)
        place = self._replaced if self.original == "REPLACE" else beside
        new = place(objects, mesh, applies)
        carrying.give_groups(made, new)
        carrying.give_keys(made, new, positions)
        texts = [summary.text(), dropped_text(result["report"]), repairs_text(result["report"])]
        if dropped and self.original == "HIDE":
            texts.append(rpt("the original has them selected"))
        if applies and has_keys and self.use_attributes:
            texts.append(rpt("its shape keys were applied with the modifiers"))
        if carried.left_out:
            texts.append(rpt("not taken over: {}").format(", ".join(carried.left_out)))
        return "; ".join(filter(None, texts))

    def _replaced(self, objects: list[bpy.types.Object], mesh: bpy.types.Mesh, applies: bool) -> bpy.types.Object:
        """Puts a mesh in the place of that of objects, and of all that share it."""
        old = objects[0].data
        if applies:
            objects[0].data = mesh
            drop_modifiers(objects[0])
        else:
            for object in bpy.data.objects:
                if object.data == old and not self._applies(object):
                    object.data = mesh
        if old.users == 0:
            name = old.name
            bpy.data.meshes.remove(old)
            mesh.name = name
        return objects[0]


def beside(objects: list[bpy.types.Object], mesh: bpy.types.Mesh, applies: bool) -> bpy.types.Object:
    """Makes a new object with a mesh for each of some objects, and hides these. The first of the new ones."""
    layer = bpy.context.view_layer
    made = []
    for object in objects:
        new = object.copy()
        new.name = f"{object.name} {rpt('quads')}"
        new.data = mesh
        if applies:
            drop_modifiers(new)
        for collection in object.users_collection:
            collection.objects.link(new)
        if object.name in layer.objects:
            was_active = layer.objects.active == object
            new.select_set(object.select_get())
            if was_active:
                layer.objects.active = new
            object.hide_set(True)
        else:
            object.hide_viewport = True
        object.hide_render = True
        made.append(new)
    return made[0]


def drop_modifiers(object: bpy.types.Object) -> None:
    """Removes the modifiers that were applied."""
    for modifier in [modifier for modifier in object.modifiers if modifier.show_viewport]:
        object.modifiers.remove(modifier)
