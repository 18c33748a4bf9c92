# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the pictures of `docs/gallery`, before and after: ``python gallery.py [NAME...]``. The environment is that of the
tests.
"""

from __future__ import annotations

import math
import os
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
OUT = ROOT / "docs" / "gallery"
#: Side of a picture, pixels, and samples of a pixel.
SIZE = 480
SAMPLES = 32
#: Thickness of drawn edges, in sizes of the object.
LINE = 0.0028
#: Directions of the view: around the upright axis and above the ground.
TURN, RISE = math.radians(32.0), math.radians(22.0)
SURFACE, EDGES = (0.50, 0.60, 0.70, 1.0), (0.03, 0.05, 0.08, 1.0)
CLAY, TEAL = (0.72, 0.36, 0.20, 1.0), (0.12, 0.42, 0.45, 1.0)


def main() -> int:
    """Runs this file again in Blender."""
    sys.path.insert(0, str(HERE))
    from check import BLENDERS, blender, variables

    python = blender(BLENDERS[0])
    if python is None:
        return 1
    return subprocess.run([python, __file__, "--inside", *sys.argv[1:]], env=variables()).returncode


def material(name: str, color: tuple[float, ...]):
    """A plain material."""
    import bpy

    made = bpy.data.materials.get(name) or bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = color
    shader.inputs["Roughness"].default_value = 0.6
    return made


def finished(object):
    """An object with the plain material alone."""
    object.data.materials.clear()
    object.data.materials.append(material("surface", SURFACE))
    return object


def quads(**settings):
    """Runs the operator."""
    import bpy

    return bpy.ops.seamstress.quads(**settings)


def monkey():
    """A monkey subdivided by a modifier."""
    import bpy

    bpy.ops.mesh.primitive_monkey_add()
    object = finished(bpy.context.object)
    object.modifiers.new("Subdivision", "SUBSURF").levels = 2
    bpy.ops.object.shade_smooth()
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    triangulated(object)
    return object, lambda: quads(faces=2400, symmetry={"X"})


def triangulated(object) -> None:
    """Splits the faces of an object."""
    import bpy

    object.modifiers.new("Triangulate", "TRIANGULATE")
    bpy.ops.object.modifier_apply(modifier="Triangulate")


def bracket():
    """The sample of a mechanical part."""
    import bpy

    bpy.ops.wm.obj_import(filepath=str(ROOT / "samples" / "bracket.obj"), forward_axis="Y", up_axis="Z")
    return finished(bpy.context.object), lambda: quads(faces=900)


def cow():
    """The sample of a cow, with a seamless UV map."""
    import bpy

    bpy.ops.wm.obj_import(filepath=str(ROOT / "samples" / "spot.obj"), forward_axis="NEGATIVE_Z", up_axis="Y")
    object = finished(bpy.context.object)
    object.rotation_euler = (math.pi / 2, 0.0, math.pi)
    bpy.ops.object.shade_smooth()
    return object, lambda: bpy.ops.seamstress.seamless_uv(tile=0.8, use_checker=True)


def block():
    """A block with holes, cut by booleans."""
    import bpy

    bpy.ops.mesh.primitive_cube_add(size=2)
    object = finished(bpy.context.object)
    object.scale = (1.0, 0.7, 0.6)
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    for place, turn, radius in (
        ((0.35, 0.0, 0.0), (0.0, 0.0, 0.0), 0.34),
        ((-0.45, 0.0, 0.0), (math.pi / 2, 0.0, 0.0), 0.26),
    ):
        bpy.ops.mesh.primitive_cylinder_add(vertices=40, radius=radius, depth=4.0, location=place, rotation=turn)
        tool = bpy.context.object
        bpy.context.view_layer.objects.active = object
        modifier = object.modifiers.new("Cut", "BOOLEAN")
        modifier.object, modifier.operation = tool, "DIFFERENCE"
        bpy.ops.object.modifier_apply(modifier="Cut")
        bpy.data.objects.remove(tool)
    object.select_set(True)
    return object, lambda: quads(target="EDGE", edge_length=0.11)


def ball():
    """A ball of two materials, whose border is followed."""
    import bpy

    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=1.0)
    object = bpy.context.object
    object.data.materials.append(material("clay", CLAY))
    object.data.materials.append(material("teal", TEAL))
    for polygon in object.data.polygons:
        x, y, z = polygon.center
        polygon.material_index = int(z > 0.25 * math.sin(3.0 * math.atan2(y, x)))
    bpy.ops.object.shade_smooth()
    return object, lambda: quads(faces=900, smooth=2)


def limbs():
    """The sample of a cow."""
    object, _ = cow()
    return object, lambda: quads(faces=3000)


def adaptive():
    """The same with quads that are smaller where it bends."""
    object, _ = cow()
    return object, lambda: quads(faces=2000, adaptive=1.0)


def painted():
    """A monkey with bright paint around its eyes and mouth."""
    import bpy
    import numpy as np

    object, _ = monkey()
    places = np.array([vertex.co for vertex in object.data.vertices])
    spots = [(-0.35, -0.8, 0.24), (0.35, -0.8, 0.24), (0.0, -0.75, -0.55)]
    away = np.min([np.linalg.norm(places - spot, axis=1) for spot in spots], axis=0)
    bright = 1.0 / (1.0 + np.exp((away - 0.4) / 0.04))
    layer = object.data.color_attributes.new("paint", "FLOAT_COLOR", "POINT")
    shades = [1.0, 0.55, 0.15] * bright[:, None] + SURFACE[:3] * (1.0 - bright[:, None])
    layer.data.foreach_set("color", np.column_stack([shades, np.ones(len(shades))]).astype(np.float32).ravel())
    group = object.vertex_groups.new(name="density")
    for vertex, weight in enumerate(bright):
        group.add([vertex], float(weight), "REPLACE")
    made = bpy.data.materials.new("paint")
    made.use_nodes = True
    colors = made.node_tree.nodes.new("ShaderNodeVertexColor")
    colors.layer_name = "paint"
    shader = made.node_tree.nodes["Principled BSDF"]
    made.node_tree.links.new(colors.outputs["Color"], shader.inputs["Base Color"])
    object.data.materials[0] = made
    return object, lambda: quads(faces=3000, symmetry={"X"}, density="GROUP", density_ratio=4.0)


def strokes():
    """An egg with strokes that wind around it."""
    import bpy
    import numpy as np

    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=5, radius=1.0)
    object = finished(bpy.context.object)
    object.scale = (1.0, 1.0, 1.5)
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    bpy.ops.object.shade_smooth()
    rise = np.linspace(-1.0, 1.0, 60)
    turns = [1.2 * np.arctanh(np.sin(rise)) + start * math.pi / 3.0 for start in range(6)]
    lines = [np.column_stack([np.cos(rise) * np.cos(t), np.cos(rise) * np.sin(t), 1.5 * np.sin(rise)]) for t in turns]
    bpy.ops.object.grease_pencil_add(type="EMPTY")
    pencil = bpy.context.object
    drawing = pencil.data.layers.new("Guides").frames.new(1).drawing
    drawing.add_strokes([len(line) for line in lines])
    drawing.attributes["position"].data.foreach_set("vector", np.array(lines, np.float32).ravel())
    # It would be seen through the egg; bars are not.
    pencil.hide_render = True
    drawn = bpy.data.curves.new("Strokes", "CURVE")
    drawn.dimensions, drawn.bevel_depth = "3D", 0.02
    drawn.materials.append(material("clay", CLAY))
    for line in lines:
        spline = drawn.splines.new("POLY")
        spline.points.add(len(line) - 1)
        spline.points.foreach_set("co", np.column_stack([line, np.ones(len(line))]).astype(np.float32).ravel())
    bpy.context.collection.objects.link(bpy.data.objects.new("Strokes", drawn))
    for other in bpy.context.view_layer.objects:
        other.select_set(other is object)
    bpy.context.view_layer.objects.active = object
    return object, lambda: quads(faces=1200, align=0.0, guide_strokes={"GREASE_PENCIL"})


SCENES = {
    "monkey": monkey,
    "bracket": bracket,
    "cow": cow,
    "block": block,
    "ball": ball,
    "limbs": limbs,
    "adaptive": adaptive,
    "painted": painted,
    "strokes": strokes,
}


def edges_of(object):
    """An object of thin bars along the edges of another."""
    import bpy

    bars = object.copy()
    bars.data = object.data.copy()
    bars.data.materials.clear()
    bars.data.materials.append(material("edges", EDGES))
    bars.data.polygons.foreach_set("material_index", [0] * len(bars.data.polygons))
    wires = bars.modifiers.new("Edges", "WIREFRAME")
    wires.thickness = LINE * max(object.dimensions)
    wires.use_even_offset = False
    bpy.context.collection.objects.link(bars)
    return bars


def render(object, path: Path, has_edges: bool) -> None:
    """A picture of an object, with its edges or without."""
    import bpy
    from mathutils import Vector

    bars = [edges_of(object)] if has_edges else []
    scene = bpy.context.scene
    away = Vector((math.sin(TURN) * math.cos(RISE), -math.cos(TURN) * math.cos(RISE), math.sin(RISE)))
    turn = away.to_track_quat("Z", "Y")
    # In the axes of the camera, of which the third points to it.
    seen = [turn.inverted() @ (object.matrix_world @ vertex.co) for vertex in object.data.vertices]
    low, high = (Vector(map(pick, zip(*seen))) for pick in (min, max))
    size = max(high - low)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 1.06 * max((high - low).xy)
    camera.location = turn @ ((low + high) / 2.0) + away * 10.0 * size
    camera.data.clip_end = 100.0 * size
    camera.rotation_euler = turn.to_euler()
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.data.angle = 2.0, math.radians(20.0)
    sun.rotation_euler = (math.radians(40.0), math.radians(-12.0), math.radians(10.0))
    for added in (camera, sun):
        scene.collection.objects.link(added)
    world = scene.world or bpy.data.worlds.new("World")
    scene.world, world.use_nodes = world, True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.9, 0.93, 1.0, 1.0)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.45
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = SAMPLES, False
    scene.render.film_transparent = True
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    for added in (*bars, camera, sun):
        bpy.data.objects.remove(added)


def joined(before: Path, after: Path, path: Path) -> None:
    """Two pictures side by side on white."""
    from PIL import Image

    page = Image.new("RGB", (2 * SIZE, SIZE), "white")
    for at, name in enumerate((before, after)):
        picture = Image.open(name)
        page.paste(picture, (at * SIZE, 0), picture)
    page.quantize(96, dither=Image.Dither.NONE).save(path, optimize=True)


def inside(names: list[str]) -> None:
    """What runs in Blender."""
    sys.path.insert(0, str(HERE))
    import bpy
    import seamstress

    OUT.mkdir(exist_ok=True)
    for name in names or SCENES:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        seamstress.register()
        object, work = SCENES[name]()
        with tempfile.TemporaryDirectory() as folder:
            before, after = Path(folder, "before.png"), Path(folder, "after.png")
            render(object, before, has_edges=True)
            work()
            made = bpy.context.object
            object.hide_render = made is not object
            # The checks of a map are easier to see without.
            render(made, after, has_edges=made is not object)
            joined(before, after, OUT / f"{name}.png")
        print(f"{name}: {len(object.data.polygons)} faces, then {len(made.data.polygons)}", flush=True)
        seamstress.unregister()


if __name__ == "__main__":
    if "--inside" not in sys.argv:
        sys.exit(main())
    try:
        inside([name for name in sys.argv[1:] if name != "--inside"])
    except BaseException:
        traceback.print_exc()
        os._exit(1)
    # Blender as a module may hang when Python takes it down.
    os._exit(0)
