# SPDX-License-Identifier: GPL-3.0-or-later
"""Seamless UV and Check."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
import shapes
from seamstress.summary import Summary
from test_quads import non_manifold


def mapped(source: bpy.types.Object, **settings: object) -> bpy.types.Mesh:
    shapes.select(source)
    assert bpy.ops.seamstress.seamless_uv(**settings) == {"FINISHED"}
    return source.data


def checked(object: bpy.types.Object) -> dict[str, str] | None:
    """The figures that Check leaves of a mesh with a seamless map."""
    shapes.select(object)
    bpy.ops.seamstress.check()
    summary = Summary.stored(object.data)
    return None if summary is None else summary.figures


def test_the_map_of_a_monkey_is_certified() -> None:
    source = shapes.monkey()
    mesh = mapped(source)
    assert mesh.uv_layers.active.name == "Seamless" and len(mesh.uv_layers) == 2
    del mesh["seamstress"]
    figures = checked(source)
    assert source.mode == "OBJECT"
    assert figures["Flipped triangles"] == "0"
    cones = shapes.attribute(mesh, "seamless_cone_index")
    assert int(figures["Cones"]) == np.count_nonzero(cones)
    group = source.vertex_groups["Seamless cones"].index
    in_group = [any(g.group == group for g in vertex.groups) for vertex in mesh.vertices]
    assert (np.array(in_group) == (cones != 0)).all()


def test_scale_is_that_of_the_world() -> None:
    source = shapes.grid(8)
    source.scale = (3.0, 1.0, 1.0)
    bpy.context.view_layer.update()
    mesh = mapped(source, tile=0.5)
    assert np.allclose(shapes.uv_areas(mesh, "Seamless"), 3.0 / 16.0 / 0.25, rtol=0.01)


def soup() -> bpy.types.Object:
    """A plane whose triangles share no vertices, as some files have them."""
    source = shapes.grid(6)
    mesh = source.data
    places = shapes.positions(mesh)
    triangles = [t for p in mesh.polygons for a, b, c, d in [p.vertices] for t in ((a, b, c), (a, c, d))]
    corners = places[np.array(triangles).ravel()]
    bpy.data.objects.remove(source)
    return shapes.added("Soup", corners, np.arange(len(corners)).reshape(-1, 3).tolist())


@pytest.mark.parametrize("make", [soup, non_manifold])
def test_repaired_and_welded_surfaces_put_uvs_where_they_belong(make: Callable[[], bpy.types.Object]) -> None:
    mesh = mapped(make())
    # Faces that a repair has turned over are mirrored, as the surface goes on there.
    shares = np.abs(shapes.uv_areas(mesh, "Seamless")) / shapes.areas(mesh)
    assert np.abs(shares - 1.0).max() < 1e-4


def test_linked_meshes_are_not_changed(tmp_path: Path) -> None:
    """They belong to another file; a new object beside them is possible."""
    file = str(tmp_path / "library.blend")
    bpy.data.libraries.write(file, {shapes.monkey()})
    bpy.data.objects.remove(bpy.context.object)
    with bpy.data.libraries.load(file, link=True) as (_, wanted):
        wanted.objects = ["Suzanne"]
    (linked,) = wanted.objects
    bpy.context.collection.objects.link(linked)
    shapes.select(linked)
    for call in (bpy.ops.seamstress.seamless_uv, lambda: bpy.ops.seamstress.quads(faces=500, original="REPLACE")):
        with pytest.raises(RuntimeError, match="Suzanne is linked from another file"):
            call()
    assert bpy.ops.seamstress.quads(faces=500) == {"FINISHED"}
    assert bpy.context.object.library is None and 450 <= len(bpy.context.object.data.polygons) <= 550


def test_scale_can_be_fitted() -> None:
    mesh = mapped(shapes.cube(), scale="FIT")
    uv = shapes.attribute(mesh, "Seamless", "vector", 2)
    assert uv.min() >= 0.0 and uv.max() == pytest.approx(1.0)


def test_seams_are_where_the_map_jumps() -> None:
    source = shapes.cube(cuts=3)
    for edge in source.data.edges:
        edge.use_seam = True
    mesh = mapped(source)
    marked = {tuple(sorted(edge.vertices)) for edge in mesh.edges if edge.use_seam}
    uv = shapes.attribute(mesh, "Seamless", "vector", 2)
    at: dict[tuple[int, int], list[np.ndarray]] = {}
    for polygon in mesh.polygons:
        loops = list(polygon.loop_indices)
        for a, b in zip(loops, np.roll(loops, -1)):
            ends = sorted((mesh.loops[i].vertex_index, i) for i in (a, int(b)))
            at.setdefault((ends[0][0], ends[1][0]), []).append(uv[[ends[0][1], ends[1][1]]])
    jumps = {ends for ends, sides in at.items() if len(sides) == 2 and np.abs(sides[0] - sides[1]).max() > 1e-5}
    assert marked == jumps and 0 < len(jumps) < len(mesh.edges)


def test_no_polygon_is_torn() -> None:
    """Seams of the triangles go around polygons: their corners make polygons of the same area."""
    source = shapes.monkey()
    mesh = mapped(source)
    shares = shapes.uv_areas(mesh, "Seamless") / shapes.areas(mesh)
    assert shares.min() > 0.3 and shares.max() < 3.0


def test_features_are_on_the_axes() -> None:
    source = shapes.grid(10)
    source.rotation_euler = (0.0, 0.0, 0.4)
    mesh = mapped(source, use_boundary=True)
    uv = shapes.attribute(mesh, "Seamless", "vector", 2)
    for edge, on_border in zip(mesh.edges, shapes.border_edges(mesh)):
        if on_border:
            loop = next(loop for loop in mesh.loops if loop.edge_index == edge.index)
            polygon = next(p for p in mesh.polygons if loop.index in p.loop_indices)
            following = polygon.loop_start + (loop.index - polygon.loop_start + 1) % polygon.loop_total
            assert np.abs(uv[loop.index] - uv[following]).min() < 1e-5


def test_checker_material_shows_the_map() -> None:
    mesh = mapped(shapes.cube(), use_checker=True)
    assert [material.name for material in mesh.materials] == ["Seamless checker"]
    assert {polygon.material_index for polygon in mesh.polygons} == {0}
    nodes = mesh.materials[0].node_tree.nodes
    assert [node.uv_map for node in nodes if node.type == "UVMAP"] == ["Seamless"]


def test_maps_can_be_undone() -> None:
    shapes.monkey()
    bpy.ops.ed.undo_push(message="before")
    mapped(bpy.context.object)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert [layer.name for layer in bpy.data.objects["Suzanne"].data.uv_layers] == ["UVMap"]


def test_maps_in_edit_mode() -> None:
    source = shapes.monkey()
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.seamstress.seamless_uv() == {"FINISHED"}
    assert source.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert "Seamless" in source.data.uv_layers


def test_a_torn_map_is_no_seamless_one() -> None:
    source = shapes.monkey()
    assert checked(source) is None
    assert source.mode == "EDIT"


def test_faulty_edges_are_selected() -> None:
    source = non_manifold()
    assert bpy.ops.seamstress.check() == {"FINISHED"}
    assert source.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    selected = [edge for edge in source.data.edges if edge.select]
    places = shapes.positions(source.data)
    assert len(selected) == 4
    assert all(np.abs(places[list(edge.vertices)][:, :2]).max() < 1e-9 for edge in selected)


def test_flipped_faces_are_selected() -> None:
    source = shapes.grid(6)
    source.data.polygons[14].flip()
    source.data.update()
    bpy.ops.seamstress.check()
    bpy.ops.object.mode_set(mode="OBJECT")
    selected = {edge.index for edge in source.data.edges if edge.select}
    assert selected == {source.data.loops[i].edge_index for i in source.data.polygons[14].loop_indices}


def test_a_good_mesh_has_nothing_to_select() -> None:
    source = shapes.grid(6)
    assert bpy.ops.seamstress.check() == {"FINISHED"}
    assert source.mode == "OBJECT"


def test_figures_go_when_the_mesh_changes() -> None:
    source = shapes.monkey()
    mapped(source)
    assert Summary.stored(source.data).title == "Certified seamless map"
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert Summary.stored(source.data) is None
