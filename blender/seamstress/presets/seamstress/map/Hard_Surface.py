# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

held = bpy.context.scene.seamstress.map

held.scale = "WORLD"
held.creases = "AUTO"
held.marks = {"SHARP", "CREASE"}
