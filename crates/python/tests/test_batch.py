"""Data sets: whatever happens to a mesh costs its own row only, and what is done stays done."""

from __future__ import annotations

import csv
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shapes import cube, grid, sphere

from seamstress_mesh.batch import inputs
from seamstress_mesh.batch.__main__ import main
from seamstress_mesh.batch.manifest import NAME, Manifest
from seamstress_mesh.batch.task import Limits, Outcome, Task, flat, run

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="limits and signals of Unix")
#: Columns that vary from run to run.
VARY = {"seconds", "cpu_seconds", "memory_bytes", "worker", "finished", "attempts"}


def write_obj(path: Path, vertices: Any, faces: Any) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in vertices]
    path.write_text("\n".join([*lines, *("f " + " ".join(str(v + 1) for v in face) for face in faces)]) + "\n")


@pytest.fixture
def meshes(tmp_path: Path) -> Path:
    """Good and bad meshes in a tree of folders."""
    folder = tmp_path / "meshes"
    write_obj(folder / "sphere.obj", *sphere())
    write_obj(folder / "deep" / "sphere.obj", *sphere(6, 9))
    write_obj(folder / "deep" / "cube.obj", *cube())
    write_obj(folder / "grid.obj", *grid())
    write_obj(folder / "bad.obj", np.eye(3), [[0, 1, 2], [0, 1, 2]])
    (folder / "empty.obj").write_text("")
    (folder / "notes.txt").write_text("no mesh")
    return folder


def rows(folder: Path) -> dict[str, dict[str, Any]]:
    manifest = Manifest(folder / NAME)
    job = manifest.jobs()[-1]["id"]
    found = {row["name"]: row for row in manifest.rows(job)}
    manifest.close()
    return found


def table(folder: Path) -> dict[str, Any]:
    """What has to be the same in every run: all but costs and who bore them."""

    def same(row: dict[str, Any]) -> dict[str, Any]:
        costs = ("cost.", "seconds", "files.")
        metrics = {k: v for k, v in row["metrics"].items() if not any(cost in k for cost in costs)}
        return {**{k: v for k, v in row.items() if k not in VARY}, "metrics": metrics}

    return {name: same(row) for name, row in rows(folder).items()}


def files(folder: Path) -> dict[str, bytes]:
    """All results, by their names."""
    kinds = ("meshes", "pictures")
    found = [path for kind in kinds for path in (folder / kind).rglob("*") if path.is_file()]
    return {str(path.relative_to(folder)): path.read_bytes() for path in found}


def test_every_file_has_a_row_and_is_done_once(meshes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    call = [str(meshes), "-o", str(out), "--task", "quad", "--workers", "2", "--", "--quads", "60"]
    assert main(call) == 0
    status = {name: row["status"] for name, row in rows(out).items()}
    good = {"sphere.obj", "deep/sphere.obj", "deep/cube.obj", "grid.obj"}
    assert status == {**dict.fromkeys(good, "ok"), "bad.obj": "refused", "empty.obj": "refused"}
    assert rows(out)["bad.obj"]["code"] == "not-a-surface"
    cube_row = rows(out)["deep/cube.obj"]
    assert cube_row["metrics"]["quads.count"] > 0 and cube_row["memory_bytes"] > 1e6 and cube_row["attempts"] == 1
    assert cube_row["cpu_seconds"] > 0 and len(cube_row["sha256"]) == 64
    made = files(out)
    assert {name for name in made if name.startswith("meshes")} == {f"meshes/{name}.obj" for name in good}
    assert all(content.startswith(b"\x89PNG") for name, content in made.items() if name.endswith(".png"))
    assert not (out / ".work").exists() or not list((out / ".work").iterdir())
    said = capsys.readouterr()
    assert "6 meshes, 0 done before, 6 to do" in said.err and "4 ok, 2 refused" in said.out
    page = (out / "index.html").read_text()
    assert page.count("<article") == 6 and page.count("<img") == 4
    # Nothing is left to do; then one mesh changes, one result goes, and some are asked for again.
    main(call)
    assert "6 done before, 0 to do" in capsys.readouterr().err
    os.utime(meshes / "grid.obj")
    main(call)
    assert "6 done before, 0 to do" in capsys.readouterr().err
    write_obj(meshes / "grid.obj", *grid(9))
    (out / "meshes" / "sphere.obj.obj").unlink()
    main(call)
    assert "4 done before, 2 to do" in capsys.readouterr().err
    main([*call[:-3], "--again", "refused", *call[-3:]])
    assert "4 done before, 2 to do" in capsys.readouterr().err
    # Other options are another job.
    main([*call[:-1], "80"])
    assert "0 done before, 6 to do" in capsys.readouterr().err


def test_the_table_is_exported(meshes: Path, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    out = tmp_path / "out"
    main([str(meshes), "-o", str(out), "--no-pictures", "--quiet"])
    exported = parquet.read_table(out / "results.parquet").to_pylist()
    assert {row["name"]: row["status"] for row in exported} == {n: row["status"] for n, row in rows(out).items()}
    tau = {row["name"]: row["distortion.tau"] for row in exported}
    assert tau["sphere.obj"] == rows(out)["sphere.obj"]["metrics"]["distortion.tau"] and tau["bad.obj"] is None
    assert not (out / "pictures").exists()


def test_limits_cost_their_own_row(meshes: Path, tmp_path: Path) -> None:
    # One that never ends, and one that asks for more memory than it may have.
    os.mkfifo(meshes / "endless.obj")
    write_obj(meshes / "large.obj", *sphere(100, 150))
    out = tmp_path / "out"
    call = [str(meshes), "-o", str(out), "--workers", "2", "--timeout", "10", "--memory", "0.06", "--quiet"]
    assert main(call) == 0
    status = {name: row["status"] for name, row in rows(out).items()}
    assert status["endless.obj"] == "time-limit" and status["large.obj"] == "memory-limit"
    assert sum(one == "ok" for one in status.values()) == 4
    # With the same limits they are not tried again, with others they are.
    finished = {name: row["finished"] for name, row in rows(out).items()}
    assert main(call) == 0
    assert {name: row["finished"] for name, row in rows(out).items()} == finished
    (meshes / "endless.obj").unlink()
    main([*call, "--memory", "4", "--timeout", "300"])
    assert rows(out)["large.obj"]["status"] == "ok"


def test_cpu_limit(tmp_path: Path) -> None:
    write_obj(tmp_path / "large.obj", *sphere(200, 300))
    outcome = run(Task(str(tmp_path / "large.obj"), "large.obj", "map", (), str(tmp_path), limits=Limits(cpu=1)))
    assert (outcome.status, outcome.code) == ("cpu-limit", "SIGXCPU")


def test_usage_errors_are_rows_too(meshes: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    main([str(meshes / "grid.obj"), "-o", str(out), "--quiet", "--", "--no-such-flag"])
    row = rows(out)["grid.obj"]
    assert row["status"] == "usage" and "--no-such-flag" in row["message"]


def children_of(pid: int) -> list[int]:
    found = subprocess.run(["ps", "-e", "-o", "pid=,ppid="], capture_output=True, text=True, check=True).stdout
    pairs = (map(int, line.split()) for line in found.splitlines())
    return [child for child, parent in pairs if parent == pid]


def commands_in(folder: Path) -> list[int]:
    """The tasks that run in a folder, whoever their parents are."""
    found = subprocess.run(["ps", "-e", "-o", "pid=,args="], capture_output=True, text=True, check=True).stdout
    return [int(line.split()[0]) for line in found.splitlines() if "_command.py" in line and str(folder) in line]


@pytest.mark.skipif(sys.platform != "linux", reason="needs ps and the signal on a parent's death")
@pytest.mark.skipif(not shutil.which("ps"), reason="needs ps")
def test_kills_change_nothing(meshes: Path, tmp_path: Path) -> None:
    for k in range(6):
        write_obj(meshes / f"more_{k}.obj", *sphere(20 + k, 30))
    undisturbed, out = tmp_path / "undisturbed", tmp_path / "out"
    main([str(meshes), "-o", str(undisturbed), "--workers", "2", "--quiet"])
    command = [sys.executable, "-m", "seamstress_mesh.batch", str(meshes), "-o", str(out), "--workers", "2", "--quiet"]
    chance = random.Random(7)
    for victim in ("child", "driver", "driver"):
        batch = subprocess.Popen(command, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        time.sleep(chance.uniform(0.5, 1.5))
        children = children_of(batch.pid)
        if victim == "child" and children:
            os.kill(chance.choice(children), signal.SIGKILL)
            batch.wait(timeout=120)
            # It was tried again.
            assert all(row["status"] in ("ok", "refused") for row in rows(out).values())
            shutil.rmtree(out / "meshes" / "deep")
        elif victim == "driver":
            batch.kill()
            batch.wait()
            time.sleep(0.5)
            assert not commands_in(out)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    assert table(out) == {name: row for name, row in table(undisturbed).items()}
    assert files(out) == files(undisturbed)
    assert not list((out / ".work").iterdir()) if (out / ".work").exists() else True


def test_interrupts_end_the_children(meshes: Path, tmp_path: Path) -> None:
    write_obj(meshes / "large.obj", *sphere(200, 300))
    out = tmp_path / "out"
    command = [sys.executable, "-m", "seamstress_mesh.batch", str(meshes), "-o", str(out), "--workers", "1"]
    batch = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    time.sleep(2.0)
    batch.send_signal(signal.SIGINT)
    _, said = batch.communicate(timeout=30)
    assert batch.returncode == 1 and "the same command goes on from here" in said
    assert not commands_in(out)


def test_one_driver_at_a_time(meshes: Path, tmp_path: Path) -> None:
    from seamstress_mesh.batch.driver import alone

    with alone(tmp_path), pytest.raises(SystemExit, match="another process"):
        with alone(tmp_path):
            pass


def test_comparison(meshes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    old, new = tmp_path / "old", tmp_path / "new"
    main([str(meshes), "-o", str(old), "--quiet", "--no-pictures"])
    (meshes / "empty.obj").write_text((meshes / "sphere.obj").read_text())
    capsys.readouterr()
    call = [str(meshes), "-o", str(new), "--quiet", "--no-pictures", "--compare", str(old), "--"]
    main([*call, "--no-tau-polish"])
    said = capsys.readouterr().out
    assert "6 meshes are in both" in said and "empty.obj: refused, now ok" in said
    tau = [line for line in said.splitlines() if line.startswith("tau")][-1]
    # Without the polish tau is larger, where it is not exact already.
    assert int(tau.split()[3]) >= 2 and int(tau.split()[2]) == 0


def test_inputs(meshes: Path, tmp_path: Path) -> None:
    paths = sorted(str(path) for path in meshes.rglob("*.obj"))
    assert sorted(inputs.find([str(meshes)]).values()) == paths
    assert sorted(inputs.find([str(meshes / "**" / "*.obj")]).values()) == paths
    # Two of one name have names of their own.
    assert len(inputs.find([str(meshes / "sphere.obj"), str(meshes / "deep" / "sphere.obj")])) == 2
    listed = meshes / "list.txt"
    listed.write_text("# some\nsphere.obj\n\ndeep/cube.obj\n")
    assert set(inputs.find([str(listed)])) == {"sphere.obj", "deep/cube.obj"}
    with (meshes / "table.csv").open("w", newline="") as file:
        csv.writer(file).writerows([["kind", "mesh"], ["round", "sphere.obj"]])
    assert inputs.find([str(meshes / "table.csv")]) == {"sphere.obj": str(meshes / "sphere.obj")}
    parquet = pytest.importorskip("pyarrow.parquet")
    import pyarrow

    parquet.write_table(pyarrow.table({"path": ["deep/cube.obj"]}), meshes / "table.parquet")
    assert set(inputs.find([str(meshes / "table.parquet")])) == {"deep/cube.obj"}
    for wrong in ("none.obj", "nothing", str(meshes / "notes.md")):
        with pytest.raises(inputs.InputsError):
            inputs.find([wrong])
    assert main(["nothing", "-o", str(tmp_path / "out")]) == 2


def test_reports_are_flattened() -> None:
    report = {"a": 1, "b": {"c": "inf", "d": [1, 2], "e": None}, "f": [{"g": 1}]}
    assert dict(flat(report)) == {"a": 1, "b.c": "inf", "b.d.count": 2, "f.count": 1}


def test_rays_engine(meshes: Path, tmp_path: Path) -> None:
    pytest.importorskip("ray")
    local, out = tmp_path / "local", tmp_path / "ray"
    main([str(meshes), "-o", str(local), "--quiet"])
    command = [sys.executable, "-m", "seamstress_mesh.batch", str(meshes), "-o", str(out), "--engine", "ray", "--workers", "1"]
    subprocess.run([*command, "--quiet"], check=True, timeout=300)
    assert table(out) == table(local) and files(out) == files(local)
