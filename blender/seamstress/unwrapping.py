# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that makes seamless UV maps."""

from typing import Any

import bpy
import numpy as np
from bpy.app.translations import pgettext_rpt as rpt

from . import guiding, reading, settings
from .reading import Geometry, Unfit
from .running import Running, Task
from .selecting import select_edges
from .summary import Summary, dropped_edges, dropped_text, repairs_text
from .targets import Target

#: Names of what is made.
MAP = "Seamless"
GROUP = "Seamless cones"
INDEX = "seamless_cone_index"
CHECKER = "Seamless checker"
#: Checks along one unit of UV.
CHECKS = 8.0
#: How far UVs are apart where they jump, in lengths of the edge.
JUMP = 1e-6


class SEAMSTRESS_OT_map(settings.MapSettings, Running, bpy.types.Operator):
    """Make a seamless UV map of the selected meshes: a grid drawn in it closes up over the whole surface, except at a few \
vertices called cones. Modifiers are not applied. Runs beside Blender; Esc stops it"""

    bl_idname = "seamstress.seamless_uv"
    bl_label = "Seamless UV"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    def draw(self, context: bpy.types.Context) -> None:
        from .panel import draw_map

        draw_map(self.layout, self)

    def task(self, context: bpy.types.Context, objects: list[bpy.types.Object]) -> Task:
        object = objects[0]
        mesh = object.data
        reading.require_own(object, mesh)
        if not mesh.polygons:
            raise Unfit(rpt("{} has no faces").format(object.name))
        geometry = reading.read(mesh, reading.linear_part(object))
        options = {
            "features": reading.feature_sources(mesh, geometry, self) or ["none"],
            "align": self.align,
            "directions": guiding.directions(mesh, geometry, self),
            "cone_bias": self.cone_bias,
        }
        strokes = guiding.strokes(object, geometry, self)
        arguments = {"mesh": geometry.arrays(), "strokes": strokes, "repair": self.use_repair, "options": options}
        target = Target.of(object)

        def finish(result: dict[str, Any]) -> str:
            text = self._write(target.object(), geometry, result)
            return "; ".join(filter(None, [text, guiding.strokes_text(self, strokes)]))

        return Task(object.name, "seamless", arguments, finish)

    def _write(self, object: bpy.types.Object, geometry: Geometry, result: dict[str, Any]) -> str:
        mesh = object.data
        uv = result["uv"]
        if self.scale == "WORLD":
            uv = uv / self.tile
        else:
            low = uv.min(axis=0)
            uv = (uv - low) / max(float(np.ptp(uv, axis=0).max()), 1e-30)
        layer = mesh.uv_layers.get(MAP) or mesh.uv_layers.new(name=MAP, do_init=False)
        if layer is None:
            raise Unfit(rpt("{} has as many UV maps as there can be").format(object.name))
        layer.uv.foreach_set("vector", uv.astype(np.float32).ravel())
        layer.active = True
        if self.use_seams:
            mesh.edges.foreach_set("use_seam", is_jump(geometry, result["uv"]))
        if self.use_cones:
            mark_cones(object, result["cones"])
        if self.use_checker:
            mesh.materials.clear()
            mesh.materials.append(checker())
            mesh.polygons.foreach_set("material_index", np.zeros(len(mesh.polygons), np.int32))
        if dropped := dropped_edges(result["report"]):
            select_edges(mesh, geometry, dropped)
        mesh.update()
        summary = Summary.of_map(result["report"])
        summary.store(mesh)
        selected = rpt("they are selected") if dropped else ""
        texts = [summary.text(), dropped_text(result["report"]), selected, repairs_text(result["report"])]
        return "; ".join(filter(None, texts))


def is_jump(geometry: Geometry, uv: np.ndarray) -> np.ndarray:
    """Whether UVs of corners (k, 2) jump across an edge (e,)."""
    last = np.repeat(np.cumsum(geometry.sizes) - 1, geometry.sizes)
    first = np.repeat(np.cumsum(geometry.sizes) - geometry.sizes, geometry.sizes)
    here = np.arange(len(uv))
    following = np.where(here == last, first, here + 1)
    # Both ends of each side of a face, in the order of the vertices.
    swapped = (geometry.corners > geometry.corners[following])[:, None]
    ends = np.hstack([np.where(swapped, uv[following], uv), np.where(swapped, uv, uv[following])])
    low = np.full((len(geometry.edges), 4), np.inf)
    high = -low
    np.minimum.at(low, geometry.corner_edges, ends)
    np.maximum.at(high, geometry.corner_edges, ends)
    lengths = np.linalg.norm(np.ptp(geometry.positions[geometry.edges], axis=1), axis=1)
    return geometry.is_used & ((high - low).max(axis=1) > JUMP * lengths)


def mark_cones(object: bpy.types.Object, cones: np.ndarray) -> None:
    """Puts cones (n, 2) into a vertex group, and their indices into an attribute."""
    if old := object.vertex_groups.get(GROUP):
        object.vertex_groups.remove(old)
    object.vertex_groups.new(name=GROUP).add(cones[:, 0].tolist(), 1.0, "REPLACE")
    mesh = object.data
    attribute = mesh.attributes.get(INDEX) or mesh.attributes.new(INDEX, "INT", "POINT")
    indices = np.zeros(len(mesh.vertices), np.int32)
    indices[cones[:, 0]] = cones[:, 1]
    attribute.data.foreach_set("value", indices)


def checker() -> bpy.types.Material:
    """The material of checks that shows the map."""
    if found := bpy.data.materials.get(CHECKER):
        return found
    material = bpy.data.materials.new(CHECKER)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    uv = nodes.new("ShaderNodeUVMap")
    uv.uv_map = MAP
    checks = nodes.new("ShaderNodeTexChecker")
    checks.inputs["Scale"].default_value = CHECKS
    checks.inputs["Color1"].default_value = (0.85, 0.83, 0.78, 1.0)
    checks.inputs["Color2"].default_value = (0.12, 0.25, 0.42, 1.0)
    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    links.new(uv.outputs["UV"], checks.inputs["Vector"])
    links.new(checks.outputs["Color"], shader.inputs["Base Color"])
    uv.location, checks.location = (-500, 200), (-250, 200)
    return material
