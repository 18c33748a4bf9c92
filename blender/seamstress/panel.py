# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the sidebar of the 3D view."""

from typing import Any

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from . import running, settings
from .checking import SEAMSTRESS_OT_check
from .remeshing import SEAMSTRESS_OT_quads
from .summary import Summary
from .unwrapping import SEAMSTRESS_OT_map

#: The tab of the sidebar.
CATEGORY = "Seamstress"


def draw_features(layout: bpy.types.UILayout, held: Any) -> None:
    """Which edges are followed."""
    layout.prop(held, "creases")
    if held.creases == "ANGLE":
        layout.prop(held, "angle")
    borders = layout.row()
    borders.enabled = held.creases != "AUTO"
    borders.prop(held, "use_boundary")
    layout.column(heading="Marked").prop(held, "marks")


def draw_guides(layout: bpy.types.UILayout, held: Any) -> None:
    """Which directions are followed."""
    layout.prop(held, "align")
    layout.column(heading="Guide Edges").prop(held, "guide_marks")
    layout.column(heading="Strokes").prop(held, "guide_strokes")


def draw_density(layout: bpy.types.UILayout, held: Any) -> None:
    """How sizes vary."""
    layout.prop(held, "adaptive")
    layout.prop(held, "density")
    if held.density == "NONE":
        return
    object = bpy.context.active_object
    if object is not None and object.type == "MESH":
        where, listed = (object, "vertex_groups") if held.density == "GROUP" else (object.data, "color_attributes")
        layout.prop_search(held, "density_name", where, listed)
    layout.prop(held, "density_ratio")


def draw_quads(layout: bpy.types.UILayout, held: Any) -> None:
    """Settings of quads."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    layout.prop(held, "target")
    layout.prop(held, {"FACES": "faces", "EDGE": "edge_length", "RATIO": "ratio"}[held.target])
    layout.row(heading="Symmetry").prop(held, "symmetry")
    for draw in (draw_features, draw_guides, draw_density):
        layout.separator()
        draw(layout, held)
    layout.separator()
    layout.prop(held, "cone_bias")
    layout.prop(held, "smooth")
    layout.separator()
    layout.row().prop(held, "original", expand=True)
    for name in ("use_modifiers", "use_attributes", "use_repair"):
        layout.prop(held, name)


def draw_map(layout: bpy.types.UILayout, held: Any) -> None:
    """Settings of seamless UV maps."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    layout.row().prop(held, "scale", expand=True)
    if held.scale == "WORLD":
        layout.prop(held, "tile")
    for draw in (draw_features, draw_guides):
        layout.separator()
        draw(layout, held)
    layout.separator()
    for name in ("cone_bias", "use_seams", "use_cones", "use_checker", "use_repair"):
        layout.prop(held, name)


class Sidebar:
    """Where the panels are."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = CATEGORY


class SEAMSTRESS_PT_work(Sidebar, bpy.types.Panel):
    """What runs, and what the active mesh is."""

    bl_label = "Seamstress"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        if running.current is not None:
            text, fraction = running.current.progress
            layout.progress(factor=fraction, text=text)
            layout.operator("seamstress.stop", icon="X")
            return
        layout.operator(SEAMSTRESS_OT_check.bl_idname, icon="CHECKMARK")
        object = context.active_object
        summary = Summary.stored(object.data) if object is not None and object.type == "MESH" else None
        if summary is None:
            return
        box = layout.box()
        box.label(text=summary.title, icon="INFO")
        table = box.split(factor=0.6)
        names, figures = table.column(), table.column()
        for name, figure in summary.figures.items():
            names.label(text=name)
            figures.label(text=figure)


class SEAMSTRESS_PT_quads(Sidebar, bpy.types.Panel):
    """Quad meshes."""

    bl_label = "Quad Remesh"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        SEAMSTRESS_PT_quad_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        held = context.scene.seamstress.quads
        button = self.layout.operator(SEAMSTRESS_OT_quads.bl_idname, icon="MESH_GRID")
        settings.copy(settings.QuadSettings, held, button)
        draw_quads(self.layout, held)


class SEAMSTRESS_PT_map(Sidebar, bpy.types.Panel):
    """Seamless UV maps."""

    bl_label = "Seamless UV"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        SEAMSTRESS_PT_map_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        held = context.scene.seamstress.map
        button = self.layout.operator(SEAMSTRESS_OT_map.bl_idname, icon="UV")
        settings.copy(settings.MapSettings, held, button)
        draw_map(self.layout, held)


class SEAMSTRESS_PT_quad_presets(PresetPanel, bpy.types.Panel):
    """Presets of quad meshes."""

    bl_label = "Quad Remesh Presets"
    preset_subdir = "seamstress/quads"
    preset_operator = "script.execute_preset"
    preset_add_operator = "seamstress.add_quad_preset"


class SEAMSTRESS_OT_add_quad_preset(AddPresetBase, bpy.types.Operator):
    """Add or remove a preset of quad meshes"""

    bl_idname = "seamstress.add_quad_preset"
    bl_label = "Add Quad Remesh Preset"
    preset_menu = "SEAMSTRESS_PT_quad_presets"
    preset_subdir = "seamstress/quads"
    preset_defines = ["held = bpy.context.scene.seamstress.quads"]
    preset_values = [f"held.{name}" for name in settings.names(settings.QuadSettings)]


class SEAMSTRESS_PT_map_presets(PresetPanel, bpy.types.Panel):
    """Presets of seamless UV maps."""

    bl_label = "Seamless UV Presets"
    preset_subdir = "seamstress/map"
    preset_operator = "script.execute_preset"
    preset_add_operator = "seamstress.add_map_preset"


class SEAMSTRESS_OT_add_map_preset(AddPresetBase, bpy.types.Operator):
    """Add or remove a preset of seamless UV maps"""

    bl_idname = "seamstress.add_map_preset"
    bl_label = "Add Seamless UV Preset"
    preset_menu = "SEAMSTRESS_PT_map_presets"
    preset_subdir = "seamstress/map"
    preset_defines = ["held = bpy.context.scene.seamstress.map"]
    preset_values = [f"held.{name}" for name in settings.names(settings.MapSettings)]


def draw_object_menu(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Lines of the Object menu."""
    menu.layout.separator()
    menu.layout.operator(SEAMSTRESS_OT_quads.bl_idname, icon="MESH_GRID")
    menu.layout.operator(SEAMSTRESS_OT_check.bl_idname, icon="CHECKMARK")


def draw_uv_menu(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    """A line of the UV menu."""
    menu.layout.separator()
    menu.layout.operator(SEAMSTRESS_OT_map.bl_idname)
