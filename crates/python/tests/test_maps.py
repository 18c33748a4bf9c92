"""What is made of surfaces."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from shapes import cube, grid, is_seamless, sphere

import seamstress_mesh as sm


def test_maps_are_seamless_and_those_of_the_command(samples: Path, spot_map: sm.SeamlessMap, tmp_path: Path) -> None:
    m = spot_map
    assert is_seamless(m.surface.faces, m.uv, m.face_uv)
    assert m.cones[:, 1].sum() == 8 == 4 * m.report["input"]["euler_characteristic"]
    assert m.certificate["faces"] == len(m.face_uv)
    assert (m.corner_uv.reshape(-1, 3, 2) == m.uv[m.face_uv]).all()
    ours, theirs = tmp_path / "ours.obj", tmp_path / "theirs.obj"
    m.write(ours)
    command = [sys.executable, "-m", "seamstress_mesh", "map", str(samples / "spot.obj"), "-o", str(theirs), "--quiet"]
    subprocess.run(command, check=True)
    assert ours.read_bytes() == theirs.read_bytes()
    # The numbers of the file are those of the arrays, to the bit.
    lines = theirs.read_text().splitlines()
    uv = np.array([line.split()[1:] for line in lines if line.startswith("vt ")], dtype=float)
    corners = [part.split("/")[1] for line in lines if line.startswith("f ") for part in line.split()[1:]]
    assert (uv[np.array(corners, dtype=int) - 1] == m.corner_uv).all()


def test_threads_and_arrays_change_nothing(spot_map: sm.SeamlessMap) -> None:
    s = spot_map.surface
    again = sm.Surface(s.vertices.tolist(), s.faces.astype("u2"))
    for threads in (1, 3):
        m = again.parametrize(threads=threads)
        assert m.uv.tobytes() == spot_map.uv.tobytes() and (m.face_uv == spot_map.face_uv).all()


def test_quads_come_from_where_they_say(spot: sm.Surface, tmp_path: Path) -> None:
    q = spot.quad_mesh(600, raw=True, features="none")
    assert q.quads.shape == (q.report["quads"]["count"], 4)
    assert abs(len(q.quads) - 600) < 30
    corners = spot.vertices[spot.faces[q.source_face]]
    assert np.allclose(np.einsum("nk,nkd->nd", q.source_bary, corners), q.vertices, atol=1e-12)
    assert np.allclose(q.source_bary.sum(1), 1.0)
    # Indices add up to 4 times the Euler characteristic.
    assert q.irregular[:, 1].sum() == 8
    for ending in ("obj", "off", "ply", "stl", "glb", "obj.gz"):
        q.write(tmp_path / f"q.{ending}")
    assert len(sm.read(tmp_path / "q.ply").faces) == 2 * len(q.quads)
    assert (sm.read(tmp_path / "q.obj.gz").vertices == q.vertices).all()
    with pytest.raises(sm.InputError) as raised:
        q.write(tmp_path / "q.fbx")
    assert raised.value.code == "unwritable"


def test_integer_grid_maps_have_whole_numbers_and_quads(spot: sm.Surface) -> None:
    g = spot.integer_map(500, features="none")
    assert spot.certify(g.uv, g.face_uv, integer=True)
    # A cone lies at a grid point.
    at = {v: uv for face, uvs in zip(spot.faces, g.uv[g.face_uv]) for v, uv in zip(face, uvs)}
    assert all((at[v] == np.rint(at[v])).all() for v in g.cones[:, 0])
    q = spot.extract_quads(g.uv, g.face_uv)
    assert len(q.quads) == g.report["grid"]["quads"]
    m = spot.parametrize()
    again = spot.integer_map_of(m.uv, m.face_uv, edge_length=g.report["grid"]["edge_length"])
    assert spot.certify(again.uv, again.face_uv, integer=True)
    assert not spot.certify(m.uv, m.face_uv, integer=True)


def test_features_are_followed() -> None:
    v, quads = cube(4)
    s = sm.Surface(v, quads)
    curves = s.features(40.0)
    assert len(curves.edges) == 12 * 4
    assert sorted(curves.corners) == sorted(np.flatnonzero(np.isin(v, (0, 1)).all(1)))
    m = s.parametrize(features="angle:40")
    assert len(m.aligned_edges) == 48 and m.report["features"]["kept"] == 48
    assert (m.cones[:, 1] == 1).all() and len(m.cones) == 8
    by_edges = s.parametrize(features=curves.edges)
    assert by_edges.uv.tobytes() == m.uv.tobytes()
    # Of quads they are the default, and none if so asked.
    assert s.quad_mesh(96).report["features"]["kept"] == 48
    assert s.quad_mesh(96, features="none").report["features"] is None
    rim = sm.Surface(*grid()).parametrize(align_boundary=True)
    assert len(rim.aligned_edges) == 32
    with pytest.raises(sm.InputError) as raised:
        s.parametrize(features=[[0, 100000]])
    assert (raised.value.code, raised.value.stage) == ("bad-features", "features")
    assert raised.value.elements["edges"] == [[0, 100000]]


def test_verdicts_and_measures(spot_map: sm.SeamlessMap) -> None:
    s, m = spot_map.surface, spot_map
    verdict = s.certify(m.uv, m.face_uv)
    assert verdict and verdict.certificate == m.certificate and not verdict.violations
    broken = m.uv.copy()
    broken[m.face_uv[17]] = 0.0
    refused = s.certify(broken, m.face_uv)
    assert not refused and refused.certificate is None
    assert any(17 in violation["elements"].get("faces", []) for violation in refused.violations)
    measured = s.measure(m.uv, m.face_uv)
    assert measured["tau"]["max"] == pytest.approx(m.report["distortion"]["tau"])
    assert measured.values["tau"].shape == (len(s.faces),)
    assert measured.values["tau"].max() == pytest.approx(measured["tau"]["max"])


def test_another_objective(spot_map: sm.SeamlessMap) -> None:
    s, m = spot_map.surface, spot_map
    best = s.optimize(m.uv, m.face_uv, objective="arap")
    assert s.measure(best.uv, best.face_uv)["arap"]["mean"] < s.measure(m.uv, m.face_uv)["arap"]["mean"]
    assert is_seamless(s.faces, best.uv, best.face_uv)
    flat = sm.Surface(*grid()).optimize()
    assert len(flat.uv) == len(flat.surface.vertices) and len(flat.seams) == 0
    assert flat.report["distortion"]["symmetric_dirichlet"] == pytest.approx(4.0)


def test_fields_are_crosses(spot_map: sm.SeamlessMap) -> None:
    field = spot_map.field()
    a, b, c, d = (field.directions[:, k] for k in range(4))
    assert np.allclose(a, -c) and np.allclose(b, -d) and np.allclose((a * b).sum(1), 0.0, atol=1e-12)
    assert (field.cones == spot_map.cones).all()
    v, f = sphere()
    assert sm.Surface(v, f).field().cones[:, 1].sum() == 8


def test_all_that_is_made_pickles(spot: sm.Surface, spot_map: sm.SeamlessMap, tmp_path: Path) -> None:
    q, g = spot.quad_mesh(300), spot.integer_map(300)
    for made in (spot, spot_map, g, q, spot_map.field(), spot.features(), spot.measure(spot_map.uv, spot_map.face_uv)):
        again = pickle.loads(pickle.dumps(made))
        assert type(again) is type(made) and repr(again) == repr(made)
        for name, value in vars(made).items():
            if isinstance(value, np.ndarray):
                assert (getattr(again, name) == value).all()
            if name == "report" and made is not spot:
                assert again.report == value
    for made, name in ((spot_map, "m.obj"), (q, "q.obj")):
        made.write(tmp_path / name)
        pickle.loads(pickle.dumps(made)).write(tmp_path / f"again_{name}")
        assert (tmp_path / name).read_bytes() == (tmp_path / f"again_{name}").read_bytes()
    # What is made of a surface again is the same.
    again = pickle.loads(pickle.dumps(spot))
    assert again.parametrize().uv.tobytes() == spot_map.uv.tobytes()
    assert (pickle.loads(pickle.dumps(spot_map)).field().directions == spot_map.field().directions).all()


def test_surfaces_without_area_have_results_too() -> None:
    v, f = sphere()
    made = sm.Surface(0.0 * v, f).parametrize()
    assert "tau nan" in repr(made)
    with pytest.raises(sm.InputError) as raised:
        made.pictures()
    assert raised.value.code == "no-picture"


def test_notebooks_show_figures_and_pictures(spot: sm.Surface, spot_map: sm.SeamlessMap) -> None:
    page = spot_map._repr_html_()
    assert f"<td>{len(spot_map.cones)}</td>" in page and page.count("data:image/png;base64,iVBOR") == 2
    assert spot.quad_mesh(300)._repr_html_().count("<img") == 1
    assert {name: picture[:4] for name, picture in spot_map.pictures(view="top", up="z").items()} == {
        name: b"\x89PNG" for name in ("front", "back", "layout")
    }


def test_values_are_transferred_to_quads() -> None:
    v, quads = cube(4)
    polygons = np.array(quads)
    q = sm.Surface(v, quads).quad_mesh(384)
    # Linear on vertices, and on each side of the cube with a shift of its own.
    assert np.allclose(q.transfer(v @ [1.0, 2.0, 3.0]), q.vertices @ [1.0, 2.0, 3.0])
    side = np.arange(len(quads)) // 16
    corners = v[polygons] + 10.0 * side[:, None, None]
    found = q.transfer(corners, on="corner")
    assert found.shape == (len(q.quads), 4, 3) and np.allclose(q.transfer(corners.reshape(-1, 3), on="corner"), found)
    shifts = np.rint((found - q.vertices[q.quads]) / 10.0)
    assert np.allclose(found, q.vertices[q.quads] + 10.0 * shifts) and (shifts == shifts[:, :1, :1]).all()
    sides = q.transfer(side, on="face")
    assert sides.dtype == side.dtype and (sides == shifts[:, 0, 0]).all()
    names = q.transfer(np.array(list("abcdef"))[side], on="face")
    assert names.shape == (len(q.quads),) and (names == np.array(list("abcdef"))[sides]).all()
    assert (q.transfer(np.where(side > 2, 1.0, 0.0), on="face") == (sides > 2)).all()
    with pytest.raises(sm.InputError, match="values for 3 vertices; the mesh has"):
        q.transfer([1.0, 2.0, 3.0])
    with pytest.raises(sm.InputError, match="none of vertex, corner and face"):
        q.transfer(side, on="edge")  # type: ignore[arg-type]


def test_what_a_mesh_carries_is_seen_and_can_be_given(tmp_path: Path) -> None:
    v, quads = cube(4)
    side = np.arange(len(quads)) // 16
    corners = v[np.array(quads)].reshape(-1, 3)
    names = np.array(["up", "down"])[side % 2]
    given = [
        sm.Attribute("size", "vertex", np.where(v[:, 0] > 0.5, 1.0, 2.0)),
        sm.Attribute("paint", "vertex", np.column_stack([v, 1.0 - v[:, :1]]), "color"),
        sm.Attribute("map", "corner", corners[:, :2] + side.repeat(4)[:, None], "uv"),
        sm.Attribute("material", "face", names),
        sm.Attribute("side", "face", side),
    ]
    plain = sm.Surface(v, quads)
    surface = plain.with_attributes(given)
    assert plain.attributes == [] and len(surface.attributes) == len(given)
    for found, wanted in zip(surface.attributes, given):
        assert (found.name, found.on) == (wanted.name, wanted.on)
        assert found.kind == (wanted.kind or ("label" if wanted.on == "face" else "number"))
        assert (found.values == wanted.values).all()
    q = surface.quad_mesh(600, sizes="property:size")
    on_quads = {attribute.name: attribute for attribute in q.attributes}
    assert np.allclose(on_quads["paint"].values[:, :3], q.vertices, atol=1e-9)
    assert set(on_quads["material"].values) == {"up", "down"} and len(on_quads["side"].values) == len(q.quads)
    x = q.vertices[q.quads].mean(axis=1)[:, 0]
    assert np.count_nonzero(x > 0.75) > 1.5 * np.count_nonzero(x < 0.25)
    with pytest.raises(sm.InputError, match="values for 3"):
        plain.with_attributes([sm.Attribute("short", "vertex", np.ones(3))])
    with pytest.raises(sm.InputError, match="on 'edge'"):
        plain.with_attributes([sm.Attribute("odd", "edge", np.ones(3))])  # type: ignore[arg-type]
    q.write(tmp_path / "q.obj")
    assert "usemtl up" in (tmp_path / "q.obj").read_text()


def test_source_points_are_written(tmp_path: Path) -> None:
    v, quads = cube(4)
    q = sm.Surface(v, quads).quad_mesh(96, raw=True, source_points=True)
    carried = {attribute.name: attribute.values for attribute in q.attributes}
    at = (v[carried["source_vertex"]] * carried["source_weight"][:, :, None]).sum(axis=1)
    assert np.allclose(at, q.vertices)
    q.write(tmp_path / "q.ply")
    assert b"property double source_weight_2" in (tmp_path / "q.ply").read_bytes()


def test_a_map_is_the_first_set_of_uvs_or_the_second(tmp_path: Path) -> None:
    v, f = sphere()
    own = sm.Attribute("own", "vertex", v[:, :2] + 7.0, "uv")
    m = sm.Surface(v, f).with_attributes([own]).parametrize()
    found = {}
    for which in ("first", "second"):
        path = tmp_path / f"{which}.glb"
        m.write(path, uv_set=which)
        sets = [attribute for attribute in sm.read(path).attributes if attribute.kind == "uv"]
        found[which] = [bool(uv.values.min() > 5.0) for uv in sets]
    assert found == {"first": [False, True], "second": [True, False]}
    with pytest.raises(sm.InputError, match="neither first nor second"):
        m.write(tmp_path / "third.glb", uv_set="third")  # type: ignore[arg-type]
