# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

held = bpy.context.scene.seamstress.quads

held.target = "FACES"
held.faces = 500
held.creases = "AUTO"
held.align = 1.0
held.cone_bias = 1.0
held.smooth = 2
