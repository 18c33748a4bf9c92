# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

held = bpy.context.scene.seamstress.map

held.scale = "WORLD"
held.tile = 1.0
held.creases = "NONE"
held.use_boundary = False
