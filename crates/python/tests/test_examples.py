"""The examples run, and do what they say."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT

import seamstress_mesh as sm

EXAMPLES = ROOT / "crates" / "python" / "examples"


@pytest.fixture
def example(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(EXAMPLES)
    return importlib.import_module


@pytest.mark.parametrize("name", ["trimesh", "meshio", "igl", "pyvista", "pandas"])
def test_programs_run(name: str, samples: Path, tmp_path: Path) -> None:
    pytest.importorskip(name)
    program = EXAMPLES / f"with_{'libigl' if name == 'igl' else name}.py"
    run = [sys.executable, program, samples / "spot.obj"]
    subprocess.run(run, check=True, cwd=tmp_path, timeout=300)


def test_trimesh_keeps_the_surface(example: Any, samples: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.load(samples / "spot.obj", process=False)
    made = example("with_trimesh").textured(mesh)
    assert np.allclose(made.triangles, mesh.triangles) and made.area == pytest.approx(mesh.area)
    assert made.visual.uv.shape == (len(made.vertices), 2)


def test_meshio_writes_and_reads(example: Any, samples: Path, tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    made = example("with_meshio").quads(meshio.read(samples / "spot.obj"), 300)
    made.write(tmp_path / "quads.vtu")
    again = meshio.read(tmp_path / "quads.vtu")
    assert abs(len(again.cells_dict["quad"]) - 300) < 15
    # Quads of meshio are a surface again.
    assert len(sm.Surface(again).faces) == 2 * len(again.cells_dict["quad"])


def test_seamless_maps_are_less_distorted_than_conformal_ones(example: Any, spot: sm.Surface) -> None:
    pytest.importorskip("igl")
    module = example("with_libigl")
    energies = module.compare(module.upper_half(spot))
    assert 4.0 < energies["seamless"] < energies["libigl's LSCM"]


def test_tables_of_reports(example: Any, spot: sm.Surface) -> None:
    pytest.importorskip("pandas")
    table = example("with_pandas").table(spot, [0.0, 2.0])
    cones, energy = table["cones.count"], table["distortion.symmetric_dirichlet"]
    assert cones.loc[0.0] > cones.loc[2.0] and 4.0 < energy.loc[0.0] < energy.loc[2.0]


def test_the_notebook_runs() -> None:
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    notebook = nbformat.read(EXAMPLES / "notebook.ipynb", as_version=4)
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(EXAMPLES)}}).execute()
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    assert sum("data:image/png" in output.get("data", {}).get("text/html", "") for output in outputs) == 2
    assert "certified" in outputs[-1]["data"]["text/plain"]
