# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be set: defined once, for operators, the panel and presets."""

import math
from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

MARKS = [
    ("SHARP", "Sharp", "Edges marked sharp"),
    ("CREASE", "Crease", "Edges with a crease for subdivision"),
    ("BEVEL", "Bevel", "Edges with a bevel weight"),
    ("SEAM", "Seam", "Edges marked as UV seams"),
    ("MATERIAL", "Material", "Edges between faces of different materials"),
    ("FACE_SET", "Face Set", "Edges between different face sets of sculpting"),
]


def creases_property(default: str) -> Any:
    """Which edges are followed beside the marked ones."""
    return EnumProperty(
        name="Creases",
        description="Edges to follow beside the marked ones",
        items=[
            ("AUTO", "Automatic", "Creases found by the shape of the surface, and borders"),
            ("ANGLE", "Angle", "Edges at which the surface bends by the angle or more"),
            ("NONE", "None", "Only marked edges"),
        ],
        default=default,
    )


def boundary_property(default: bool) -> Any:
    """Whether borders are followed."""
    return BoolProperty(name="Borders", description="Follow the open borders of the surface", default=default)


def marks_property(default: set[str]) -> Any:
    """Which marks of edges are followed."""
    return EnumProperty(
        name="Marked Edges",
        description="Marks of edges that are followed",
        items=MARKS,
        options={"ENUM_FLAG"},
        default=default,
    )


class FeatureSettings:
    """Which edges are followed."""

    creases: creases_property("AUTO")
    angle: FloatProperty(
        name="Angle",
        description="The smallest bend of the surface at an edge that is followed, in degrees",
        subtype="ANGLE",
        default=math.radians(35.0),
        min=math.radians(1.0),
        max=math.radians(180.0),
    )
    use_boundary: boundary_property(True)
    marks: marks_property({"SHARP", "CREASE", "BEVEL", "MATERIAL"})


class CommonSettings:
    """What all that changes meshes has."""

    use_repair: BoolProperty(
        name="Repair",
        description="Repair the mesh first where that is possible without moving a vertex: edges of more than two faces "
        "are cut apart, repeated faces dropped, flipped faces turned. The source stays as it is",
        default=True,
    )
    cone_bias: FloatProperty(
        name="Fewer Irregular Vertices",
        description="How much to avoid irregular vertices (cones). 0 gives the lowest distortion; larger values have fewer "
        "of them",
        default=0.5,
        min=0.0,
        soft_max=2.0,
        max=100.0,
    )


def align_property(default: float) -> Any:
    """How much principal curvature is followed."""
    return FloatProperty(
        name="Follow Curvature",
        description="How much the grid follows the directions in which the surface bends most and least, as rings and lengths "
        "of limbs do. 0 gives fewer irregular vertices; 1 follows these directions as far as they are certain",
        default=default,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )


class GuideSettings:
    """Which directions are followed."""

    align: align_property(0.0)
    guide_marks: EnumProperty(
        name="Guide Edges",
        description="Marks of edges whose direction is followed wherever it can be, without lines along the edges",
        items=MARKS,
        options={"ENUM_FLAG"},
        default=set(),
    )
    guide_strokes: EnumProperty(
        name="Guide Strokes",
        description="Strokes drawn on the surface whose direction is followed wherever it can be. Those farther from it than "
        "a twentieth of its size do not count",
        items=[
            ("ANNOTATION", "Annotations", "Annotations of the scene that are shown"),
            ("GREASE_PENCIL", "Grease Pencil", "Strokes of the grease pencil objects that are shown"),
        ],
        options={"ENUM_FLAG"},
        default=set(),
    )


class DensitySettings:
    """How sizes vary over the surface."""

    adaptive: FloatProperty(
        name="Adapt to Curvature",
        description="How much smaller quads are where the surface bends, and larger elsewhere; there are as many in all. "
        "0 gives quads of one size; with 1 all leave the surface equally far",
        default=0.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    density: EnumProperty(
        name="Density",
        description="What says where quads are smaller; there are as many in all",
        items=[
            ("NONE", "None", "Nothing that is painted"),
            ("GROUP", "Vertex Group", "Quads are smaller where the weight is larger"),
            ("COLOR", "Color Attribute", "Quads are smaller where the color is brighter"),
        ],
        default="NONE",
    )
    density_name: StringProperty(
        name="Painted In",
        description="The vertex group or color attribute that says where quads are smaller; the active one if none is named",
    )
    density_ratio: FloatProperty(
        name="Edge Ratio",
        description="How many times longer edges are where weight or brightness is 0 than where it is 1, without unit",
        default=4.0,
        min=0.01,
        soft_min=1.0,
        soft_max=16.0,
        max=100.0,
    )


class QuadSettings(FeatureSettings, GuideSettings, DensitySettings, CommonSettings):
    """Settings of quad meshes."""

    align: align_property(1.0)

    target: EnumProperty(
        name="Target",
        description="What says how large the quads are",
        items=[
            ("FACES", "Faces", "About so many quads"),
            ("EDGE", "Edge Length", "The mean length of the edges of quads"),
            ("RATIO", "Ratio", "The number of quads as a share of the faces of the mesh"),
        ],
        default="FACES",
    )
    faces: IntProperty(
        name="Faces", description="Number of quads of each object", default=4000, min=4, soft_max=100_000, max=5_000_000
    )
    edge_length: FloatProperty(
        name="Edge Length",
        description="Mean length of the edges of quads, in units of the scene, with the scale of the object",
        default=0.1,
        min=1e-6,
        soft_min=1e-3,
        precision=4,
        subtype="DISTANCE",
        unit="LENGTH",
    )
    ratio: FloatProperty(
        name="Ratio",
        description="Number of quads as a share of the faces of the mesh, without unit",
        default=1.0,
        min=1e-4,
        soft_max=10.0,
        max=1000.0,
    )
    symmetry: EnumProperty(
        name="Symmetry",
        description="Make quads that are symmetric at planes of the object, through its origin or its middle. An object that "
        "is not symmetric there is refused, with how far it is from it",
        items=[(axis, axis, f"Symmetric at the plane across the {axis} axis of the object") for axis in "XYZ"],
        options={"ENUM_FLAG"},
        default=set(),
    )
    smooth: IntProperty(
        name="Smooth",
        description="Move vertices along the surface this many times, to even out angles and lengths",
        default=0,
        min=0,
        soft_max=20,
        max=1000,
    )
    use_modifiers: BoolProperty(
        name="Apply Modifiers",
        description="Work on what the modifiers show in the viewport, and leave them out of the result. Otherwise work on "
        "the mesh below them, and keep them",
        default=True,
    )
    use_attributes: BoolProperty(
        name="Keep Attributes",
        description="Take over materials, UV maps, colors, vertex groups, shape keys, custom normals, and marks of edges",
        default=True,
    )
    original: EnumProperty(
        name="Original",
        description="What becomes of the mesh",
        items=[
            ("HIDE", "Hide", "Make a new object, and hide the original"),
            ("REPLACE", "Replace", "Change the mesh of the object, and of all that share it and have no modifiers applied"),
        ],
        default="HIDE",
    )


class MapSettings(FeatureSettings, GuideSettings, CommonSettings):
    """Settings of seamless UV maps."""

    creases: creases_property("NONE")
    use_boundary: boundary_property(False)
    marks: marks_property(set())
    scale: EnumProperty(
        name="Scale",
        description="The scale of the UV map",
        items=[
            ("WORLD", "World", "As many units of the scene to a unit of UV as the tile size says"),
            ("FIT", "Fit", "The whole map in the unit square"),
        ],
        default="WORLD",
    )
    tile: FloatProperty(
        name="Tile Size",
        description="Length on the surface of one unit of UV, in units of the scene",
        default=1.0,
        min=1e-6,
        soft_min=1e-3,
        subtype="DISTANCE",
        unit="LENGTH",
    )
    use_seams: BoolProperty(
        name="Mark Seams", description="Mark the edges across which the map jumps as UV seams", default=True
    )
    use_cones: BoolProperty(
        name="Cones as Vertex Group",
        description="Put the vertices around which the map turns by another angle than a full turn into a vertex group",
        default=True,
    )
    use_checker: BoolProperty(
        name="Checker Material",
        description="Show the map by a material of checks, in place of the materials of the object",
        default=False,
    )


def names(kind: type) -> list[str]:
    """The names of the settings of a class, those of its bases first."""
    found: dict[str, None] = {}
    for base in reversed(kind.__mro__):
        found.update(dict.fromkeys(getattr(base, "__annotations__", {})))
    return list(found)


def copy(kind: type, source: Any, target: Any) -> None:
    """Copies settings of a kind from one holder to another."""
    for name in names(kind):
        setattr(target, name, getattr(source, name))


class SEAMSTRESS_PG_quads(QuadSettings, bpy.types.PropertyGroup):
    """Settings of quad meshes as the panel shows them."""


class SEAMSTRESS_PG_map(MapSettings, bpy.types.PropertyGroup):
    """Settings of seamless UV maps as the panel shows them."""


class SEAMSTRESS_PG_scene(bpy.types.PropertyGroup):
    """All settings of a scene."""

    quads: PointerProperty(type=SEAMSTRESS_PG_quads)
    map: PointerProperty(type=SEAMSTRESS_PG_map)
