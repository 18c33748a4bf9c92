"""Whatever people have as a mesh is taken for what it is, or refused by name."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from shapes import cube, grid, sphere

import seamstress_mesh as sm

FLOATS = ["f2", "f4", "f8", ">f8", "<f4", "g", "i1", "i4", "i8", "u2", "?"]
INTS = ["i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", ">i4", ">i8", "f4", "f8"]
LAYOUTS = {
    "C": np.ascontiguousarray,
    "F": np.asfortranarray,
    "reversed view": lambda array: np.ascontiguousarray(array[::-1])[::-1],
    "strided": lambda array: np.repeat(array, 2, axis=0)[::2],
    "read-only": lambda array: np.frombuffer(array.tobytes(), array.dtype).reshape(array.shape),
}


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.sampled_from(FLOATS), st.sampled_from(INTS), st.sampled_from(list(LAYOUTS)), st.sampled_from(list(LAYOUTS)))
def test_dtypes_and_orders_make_no_difference(floats: str, ints: str, of_v: str, of_f: str) -> None:
    # A tetrahedron with whole coordinates, which every dtype can hold.
    v = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    f = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    surface = sm.Surface(LAYOUTS[of_v](v.astype(floats)), LAYOUTS[of_f](f.astype(ints)))
    assert surface.vertices.dtype == np.float64 and (surface.vertices == v).all()
    assert surface.faces.dtype == np.int64 and (surface.faces == f).all()


@settings(max_examples=100, deadline=None)
@given(
    st.lists(st.lists(st.floats(width=64), min_size=3, max_size=3), max_size=6),
    st.lists(st.lists(st.integers(-(2**70), 2**70) | st.integers(-1, 6), max_size=5), max_size=6),
)
def test_anything_is_a_surface_or_an_input_error(v: list[list[float]], f: list[list[int]]) -> None:
    try:
        surface = sm.Surface(v, f)
    except sm.InputError as error:
        assert error.code and str(error)
    else:
        assert surface.faces.max() < len(v)


def test_lists_quads_and_polygons() -> None:
    v, quads = cube()
    surface = sm.Surface(v, np.array(quads))
    assert len(surface.faces) == 2 * len(quads)
    assert (np.bincount(surface.face_origin) == 2).all()
    assert (sm.Surface(v.tolist(), quads).faces == surface.faces).all()
    # The top as one polygon with the rim of its corners, among the quads.
    mixed = [list(quad) for quad in quads[:-1]] + [[quads[-1][0], quads[-1][1], quads[-1][2]], list(quads[-1])[2:] + [quads[-1][0]]]
    split = sm.Surface(v, mixed)
    assert len(split.faces) == 2 * (len(quads) - 1) + 2
    assert split.face_origin.max() == len(mixed) - 1


def test_meshes_of_any_kind() -> None:
    v, f = sphere()
    expected = sm.Surface(v, f)
    block = SimpleNamespace(type="triangle", data=f)
    lines = SimpleNamespace(type="line", data=np.array([[0, 1]]))
    for mesh in (
        SimpleNamespace(vertices=v, faces=f),
        SimpleNamespace(points=v, cells=[lines, block]),
        SimpleNamespace(points=v, cells=[SimpleNamespace(type="triangle", data=part) for part in (f[:5], f[5:])]),
    ):
        made = sm.Surface(mesh)
        assert (made.faces == expected.faces).all() and (made.vertices == expected.vertices).all()
    v2, f2 = grid(2)
    flat = SimpleNamespace(points=v2[:, :2], cells=[SimpleNamespace(type="triangle", data=f2)])
    assert (sm.Surface(flat).vertices == v2).all()


@pytest.mark.parametrize(
    "v, f, text",
    [
        (np.zeros((4, 2)), [[0, 1, 2]], "shape (4, 2)"),
        (np.zeros(4), [[0, 1, 2]], "shape (4,)"),
        (np.zeros((4, 3), complex), [[0, 1, 2]], "complex128"),
        (np.array([["a", "b", "c"]]), [[0, 0, 0]], "dtype"),
        (np.eye(3), [[0, 1, -1]], "-1 in row 0"),
        (np.eye(3), [[0, 1, 2.5]], "2.5 in row 0"),
        (np.eye(3), [[0, 1, np.nan]], "nan in row 0"),
        (np.eye(3), [[0, 1, 2**40]], "in row 0"),
        (np.eye(3), [[0, 1, 3]], "vertex 3"),
        (np.eye(3), [0, 1, 2], "shape (3,)"),
        (np.eye(3), np.zeros((2, 2, 2)), "shape (2, 2, 2)"),
        (np.full((3, 3), np.nan), [[0, 1, 2]], "finite"),
    ],
)
def test_what_is_wrong_with_arrays_is_named(v: object, f: object, text: str) -> None:
    with pytest.raises(sm.InputError) as raised:
        sm.Surface(v, f)
    assert text in str(raised.value)
    assert raised.value.code == "not-a-surface"


def test_what_is_no_mesh_is_refused() -> None:
    for thing in (None, 3, object(), np.eye(3), SimpleNamespace(points=np.eye(3), cells=[])):
        with pytest.raises(sm.InputError):
            sm.Surface(thing)


def test_uvs_of_corners_and_of_vertices(spot_map: sm.SeamlessMap) -> None:
    s, m = spot_map.surface, spot_map
    for given in ((m.uv, m.face_uv), (m.corner_uv,), (m.corner_uv.reshape(-1, 3, 2),), (m.uv.tolist(), m.face_uv.astype("u2"))):
        assert s.certify(*given).report == s.certify(m.uv, m.face_uv).report
    v, f = grid()
    flat = sm.Surface(v, f)
    # One a vertex: positions in the plane.
    verdict = flat.certify(v[:, :2])
    assert verdict and verdict.report["cones"]["count"] == 0
    assert flat.measure(v[:, :2])["tau"]["max"] == pytest.approx(1.0)
    with pytest.raises(sm.InputError, match="shape"):
        flat.certify(v)
    with pytest.raises(sm.InputError) as raised:
        flat.certify(v[:, :2], f[:-1])
    assert raised.value.code == "not-a-map"
