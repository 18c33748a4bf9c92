"""Every kind of error is the exception of its kind, with all it knows."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Callable

import numpy as np
import pytest
from shapes import grid, sphere

import seamstress_mesh as sm
from seamstress_mesh import _errors


def bow_tie() -> tuple[np.ndarray, np.ndarray]:
    """Three triangles at one edge."""
    v = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0]], float)
    return v, np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])


def test_the_tree() -> None:
    assert issubclass(sm.InputError, (sm.SeamstressError, ValueError))
    assert issubclass(sm.NoCertifiedMap, (sm.SeamstressError, RuntimeError))
    assert issubclass(sm.Stopped, (sm.SeamstressError, RuntimeError))
    for kind in (sm.InputError, sm.NoCertifiedMap, sm.Stopped):
        assert issubclass(kind, sm.SeamstressError)


def test_faults_of_a_mesh_are_listed() -> None:
    with pytest.raises(sm.InputError) as raised:
        sm.Surface(*bow_tie())
    error = raised.value
    assert (error.code, error.stage) == ("not-a-surface", "check")
    assert [0, 1] in error.elements["edges"]
    assert {finding["severity"] for finding in error.findings} == {"error"}
    assert error.hint == "all of them can be repaired: add `repair`"
    assert f"hint: {error.hint}" in str(error)
    repaired = sm.Surface(*bow_tie(), repair=True)
    assert len(repaired.faces) == 3 and repaired.report["repairs"]
    assert repaired.vertex_origin.max() == 4


@pytest.mark.parametrize(
    "call, code",
    [
        (lambda s: sm.read("there/is/none.obj"), "unreadable"),
        (lambda s: s.parametrize(cone_bias=-1.0), "options"),
        (lambda s: s.parametrize(cone_bias=float("nan")), "options"),
        (lambda s: s.parametrize(cone_bias="much"), "options"),
        (lambda s: s.parametrize(cone_bias=object()), "options"),
        (lambda s: s.parametrize(objective="none such"), "options"),
        (lambda s: s.parametrize(corner_angle=0.0), "options"),
        (lambda s: s.parametrize(threads=0), "options"),
        (lambda s: s.parametrize(timeout=-1.0), "options"),
        (lambda s: s.parametrize(features="no such source"), "options"),
        (lambda s: s.parametrize(features=np.zeros((2, 3))), "bad-features"),
        (lambda s: s.parametrize(features="lines"), "bad-features"),
        (lambda s: s.quad_mesh(), "options"),
        (lambda s: s.quad_mesh(100, scale=1.0), "options"),
        (lambda s: s.quad_mesh(-5), "options"),
        (lambda s: s.quad_mesh(edge_length=1e-9), "options"),
        (lambda s: s.certify(np.zeros((5, 2)), [[0, 1, 2]]), "not-a-map"),
        (lambda s: s.integer_map_of(np.zeros((len(s.vertices), 2)), quads=10), "not-a-map"),
        (lambda s: s.extract_quads(s.vertices[:, :2] * 0.4), "no-quads"),
        (lambda s: sm.Surface(*sphere()).optimize(), "options"),
        (lambda s: s.parametrize().write("there/is/none/map.obj"), "unwritable"),
        (lambda s: s.parametrize().write("map.off"), "unwritable"),
    ],
)
def test_input_errors(call: Callable[[sm.Surface], object], code: str) -> None:
    with pytest.raises(sm.InputError) as raised:
        call(sm.Surface(*grid()))
    assert raised.value.code == code


def test_no_certified_map() -> None:
    # The sides of a flat triangle cannot all lie on axes.
    s = sm.Surface(*grid())
    a, b, c = s.faces[40]
    sides = [[a, b], [b, c], [c, a]]
    with pytest.raises(sm.NoCertifiedMap) as raised:
        s.parametrize(features=sides, features_strict=True)
    error = raised.value
    assert error.code == "dropped-features" and error.elements["edges"]
    assert "features_strict" in (error.hint or "")
    assert s.parametrize(features=sides).report["features"]["dropped"]


def test_other_results_that_cannot_be_vouched_for() -> None:
    # A flat square in one cell, whose sides are glued: its quad has one vertex four times.
    v, f = grid(4)
    x, y = np.arange(25) % 5, np.arange(25) // 5
    a, b = 2 * np.pi * x / 4, 2 * np.pi * y / 4
    v = np.column_stack([(3 + np.cos(b)) * np.cos(a), (3 + np.cos(b)) * np.sin(a), np.sin(b)])
    glued = (x % 4) + 5 * (y % 4)
    used, numbered = np.unique(glued[f], return_inverse=True)
    torus = sm.Surface(v[used], numbered.reshape(-1, 3))
    uv = np.column_stack([x, y])[f] / 4.0
    with pytest.raises(sm.NoCertifiedMap) as raised:
        torus.extract_quads(uv)
    assert (raised.value.code, raised.value.stage) == ("not-a-manifold", "extraction")
    assert len(torus.extract_quads(uv, best_effort=True).quads) == 1
    # Eight cones in the room of a cell, rounded without constraints.
    with pytest.raises(sm.NoCertifiedMap) as raised:
        sm.Surface(*sphere()).integer_map(1, rounding="greedy")
    assert (raised.value.code, raised.value.stage) == ("no-integer-map", "quantization")


def test_misspelled_keywords_are_type_errors() -> None:
    s = sm.Surface(*grid())
    for call in (
        lambda: s.parametrize(cone_bais=1),
        lambda: s.quad_mesh(10, time_limit=1),
        lambda: s.certify(s.vertices[:, :2], thread=1),
        lambda: sm.Surface(*grid(), repairs=True),
    ):
        with pytest.raises(TypeError, match="unexpected keyword"):
            call()


def test_errors_pickle() -> None:
    with pytest.raises(sm.InputError) as raised:
        sm.Surface(*bow_tie())
    again = pickle.loads(pickle.dumps(raised.value))
    assert vars(again) == vars(raised.value) and str(again) == str(raised.value) and type(again) is sm.InputError


def test_hints_use_the_names_of_this_package() -> None:
    error = _errors.made("Stopped", "late", '{"code": "time-limit", "hint": "allow more with `time_limit`"}')
    assert error.hint == "allow more with `timeout`"


def test_a_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "bad.obj"
    path.write_text("v 0 0 0\nf 1 2 3\n")
    with pytest.raises(sm.InputError, match="bad.obj"):
        sm.read(path)
