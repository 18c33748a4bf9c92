# SPDX-License-Identifier: GPL-3.0-or-later
"""Seamstress in Blender: certified seamless UV maps and quad meshes.

`reading` makes arrays of meshes, `guiding` of what is painted and drawn on them; `running` and `jobs` have them worked on in
another process (`worker`), `remeshing`, `unwrapping` and `checking` are the operators, `carrying` what becomes of what
meshes carry.
"""

from pathlib import Path

import bpy
from bpy.props import PointerProperty

from . import checking, panel, remeshing, running, settings, unwrapping

CLASSES = [
    settings.SEAMSTRESS_PG_quads,
    settings.SEAMSTRESS_PG_map,
    settings.SEAMSTRESS_PG_scene,
    running.SEAMSTRESS_OT_stop,
    remeshing.SEAMSTRESS_OT_quads,
    unwrapping.SEAMSTRESS_OT_map,
    checking.SEAMSTRESS_OT_check,
    panel.SEAMSTRESS_OT_add_quad_preset,
    panel.SEAMSTRESS_OT_add_map_preset,
    panel.SEAMSTRESS_PT_quad_presets,
    panel.SEAMSTRESS_PT_map_presets,
    panel.SEAMSTRESS_PT_work,
    panel.SEAMSTRESS_PT_quads,
    panel.SEAMSTRESS_PT_map,
]
MENUS = [("VIEW3D_MT_object", panel.draw_object_menu), ("VIEW3D_MT_uv_map", panel.draw_uv_menu)]
#: Presets that come with the extension.
PRESETS = str(Path(__file__).with_name("presets"))


def register() -> None:
    for kind in CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.Scene.seamstress = PointerProperty(type=settings.SEAMSTRESS_PG_scene)
    for name, draw in MENUS:
        getattr(bpy.types, name).append(draw)
    bpy.utils.register_preset_path(str(Path(__file__).parent))


def unregister() -> None:
    if running.current is not None:
        running.current.cancel()
        running.current = None
    bpy.utils.unregister_preset_path(str(Path(__file__).parent))
    for name, draw in MENUS:
        getattr(bpy.types, name).remove(draw)
    del bpy.types.Scene.seamstress
    for kind in reversed(CLASSES):
        bpy.utils.unregister_class(kind)
