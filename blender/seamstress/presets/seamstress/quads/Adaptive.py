# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

held = bpy.context.scene.seamstress.quads

held.creases = "AUTO"
held.align = 1.0
held.adaptive = 1.0
held.cone_bias = 0.5
held.smooth = 0
