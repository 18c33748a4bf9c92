"""Data sets: whatever happens to a mesh costs its own row only, and what is done stays done."""

from __future__ import annotations

import csv
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import kills
import numpy as np
import pytest
from kills import files, rows, table
from shapes import cube, grid, sphere

from seamstress_mesh.batch import inputs
from seamstress_mesh.batch.__main__ import main
from seamstress_mesh.batch.task import Limits, Task, flat, run

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="limits and signals of Unix")


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
    # One that never ends, one that is large when it is unpacked, and one that takes more memory than it may have.
    kills.plant(meshes / "planted", 2e9)
    write_obj(meshes / "large.obj", *sphere(100, 150))
    out = tmp_path / "out"
    call = [str(meshes), "-o", str(out), "--workers", "2", "--timeout", "10", "--memory", "0.06", "--quiet"]
    assert main(call) == 0
    status = {name: row["status"] for name, row in rows(out).items()}
    assert status["planted/endless.obj"] == "time-limit"
    assert status["large.obj"] == status["planted/hog.obj.gz"] == "memory-limit"
    assert sum(one == "ok" for one in status.values()) == 4
    # With the same limits they are not tried again, with others they are.
    finished = {name: row["finished"] for name, row in rows(out).items()}
    assert main(call) == 0
    assert {name: row["finished"] for name, row in rows(out).items()} == finished
    shutil.rmtree(meshes / "planted")
    main([*call, "--memory", "4", "--timeout", "300"])
    assert rows(out)["large.obj"]["status"] == "ok"


def test_memory_asked_for_while_running(tmp_path: Path) -> None:
    # Two triangles with a grid of thirty million cells, which would take 30 GB.
    for name, w, h in (("few", 6, 5), ("many", 6000, 5000)):
        corners = [(0, 0), (w, 0), (w, h), (0, h)]
        lines = [f"v {x / w} {y / h} 0" for x, y in corners] + [f"vt {x} {y}" for x, y in corners]
        path = tmp_path / "in" / f"{name}.obj"
        path.parent.mkdir(exist_ok=True)
        path.write_text("\n".join([*lines, "f 1/1 2/2 3/3", "f 1/1 3/3 4/4", ""]))
    out = tmp_path / "out"
    assert main([str(tmp_path / "in"), "-o", str(out), "--task", "extract", "--memory", "1", "--quiet"]) == 0
    found = rows(out)
    assert (found["few.obj"]["status"], found["few.obj"]["metrics"]["quads.count"]) == ("ok", 30)
    assert found["many.obj"]["status"] == "memory-limit" and set(files(out)) == {"meshes/few.obj.obj"}


def test_cpu_limit(tmp_path: Path) -> None:
    write_obj(tmp_path / "large.obj", *sphere(200, 300))
    outcome = run(Task(str(tmp_path / "large.obj"), "large.obj", "map", (), str(tmp_path), limits=Limits(cpu=1)))
    assert (outcome.status, outcome.code) == ("cpu-limit", "SIGXCPU")


def test_usage_errors_are_rows_too(meshes: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    main([str(meshes / "grid.obj"), "-o", str(out), "--quiet", "--", "--no-such-flag"])
    row = rows(out)["grid.obj"]
    assert row["status"] == "usage" and "--no-such-flag" in row["message"]


linux_only = pytest.mark.skipif(sys.platform != "linux", reason="finds processes in /proc")


@linux_only
@pytest.mark.parametrize("engine", ["local", "ray"])
def test_kills_change_nothing(engine: str, tmp_path: Path) -> None:
    if engine == "ray":
        pytest.importorskip("ray")
    # Small folders first: names of sockets are short.
    for k in range(6):
        write_obj(tmp_path / "in" / "of one size" / f"sphere {k}.obj", *sphere(40 + k, 60))
    write_obj(tmp_path / "in" / "bad.obj", np.eye(3), [[0, 1, 2], [0, 1, 2]])
    options = ["--workers", "2", "--no-pictures"]
    _, faults = kills.demonstrate([str(tmp_path / "in")], [engine], 1, tmp_path, 7, options)
    assert not faults, faults
    assert [row["status"] for row in rows(tmp_path / engine).values()] == ["refused", *["ok"] * 6]


@linux_only
def test_differences_are_found(meshes: Path, tmp_path: Path) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    for out in (one, other):
        main([str(meshes), "-o", str(out), "--quiet", "--no-pictures"])
    assert not kills.differences(one, other)
    (other / "meshes" / "grid.obj.obj").write_text("half")
    (other / ".work" / "left").mkdir(parents=True)
    assert len(kills.differences(one, other)) == 2
    (meshes / "grid.obj").unlink()
    main([str(meshes), "-o", str(other), "--quiet", "--no-pictures", "--", "--no-tau-polish"])
    assert any("only in one table" in fault for fault in kills.differences(one, other))


def test_interrupts_end_the_children(meshes: Path, tmp_path: Path) -> None:
    write_obj(meshes / "large.obj", *sphere(200, 300))
    out = tmp_path / "out"
    command = [sys.executable, "-m", "seamstress_mesh.batch", str(meshes), "-o", str(out), "--workers", "1"]
    environment = {**os.environ, kills.MARK: str(out)}
    # Where the tests themselves run in the background, interrupts are ignored, and children inherit that.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    batch = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, env=environment)
    signal.signal(signal.SIGINT, before)

    # As soon as the largest mesh, which is the first, is at work.
    def is_at_work() -> bool:
        return any("_command.py" in command for _, command in kills.processes(str(out)).values())

    started = time.monotonic()
    while sys.platform == "linux" and not is_at_work():
        assert time.monotonic() - started < 60, "no child has started"
        time.sleep(0.05)
    time.sleep(0.2 if sys.platform == "linux" else 2.0)
    batch.send_signal(signal.SIGINT)
    _, said = batch.communicate(timeout=30)
    assert batch.returncode == 1 and "the same command goes on from here" in said
    assert not kills.processes(str(out))


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
    # In one folder with the run before: back again, it is better.
    main([str(meshes), "-o", str(new), "--quiet", "--no-pictures", "--compare", str(new)])
    tau = [line for line in capsys.readouterr().out.splitlines() if line.startswith("tau")][-1]
    assert int(tau.split()[3]) == 0 and int(tau.split()[2]) >= 2


def test_inputs(meshes: Path, tmp_path: Path) -> None:
    def find(given: list[str]) -> dict[str, str]:
        return inputs.find(given, tmp_path / "out")

    paths = sorted(str(path) for path in meshes.rglob("*.obj"))
    assert sorted(find([str(meshes)]).values()) == paths
    assert sorted(find([str(meshes / "**" / "*.obj")]).values()) == paths
    # Two of one name have names of their own.
    assert len(find([str(meshes / "sphere.obj"), str(meshes / "deep" / "sphere.obj")])) == 2
    listed = meshes / "list.txt"
    listed.write_text("# some\nsphere.obj\n\ndeep/cube.obj\n")
    assert set(find([str(listed)])) == {"sphere.obj", "deep/cube.obj"}
    with (meshes / "table.csv").open("w", newline="") as file:
        csv.writer(file).writerows([["kind", "mesh"], ["round", "sphere.obj"]])
    assert find([str(meshes / "table.csv")]) == {"sphere.obj": str(meshes / "sphere.obj")}
    parquet = pytest.importorskip("pyarrow.parquet")
    import pyarrow

    columns = {"kind": ["box"], "faces": [192], "path": ["deep/cube.obj"], "by": [None]}
    parquet.write_table(pyarrow.table(columns), meshes / "table.parquet")
    assert set(find([str(meshes / "table.parquet")])) == {"deep/cube.obj"}
    for wrong in ("none.obj", "nothing", str(meshes / "notes.md")):
        with pytest.raises(inputs.InputsError):
            find([wrong])
    assert main(["nothing", "-o", str(tmp_path / "out")]) == 2


def test_names_of_any_kind(tmp_path: Path) -> None:
    # As they come: blanks, letters of any script, two of one name, bytes that are no text, a link to itself.
    folder, out = tmp_path / "my meshes", tmp_path / "my meshes" / "out"
    places = ["a b/grid 1.obj", "c/grid 1.obj", "\u00e4\u732b 'x' & #1?.obj", os.fsdecode(b"b\xe4d.obj")]
    for place in places:
        write_obj(folder / place, *grid(3))
    (folder / "c" / "again").symlink_to(folder)
    call = [str(folder), "-o", str(out), "--quiet"]
    assert main(call) == 0
    names = {*places[:3], "b\\xe4d.obj"}
    assert {name: row["status"] for name, row in rows(out).items()} == dict.fromkeys(names, "ok")
    assert set(files(out)) == {f"meshes/{name}.obj" for name in names} | {f"pictures/{name}.png" for name in names}
    # Its own results are no meshes of the next run, and what is done is found.
    finished = {name: row["finished"] for name, row in rows(out).items()}
    assert main(call) == 0
    assert {name: row["finished"] for name, row in rows(out).items()} == finished
    page = (out / "index.html").read_text()
    assert all((out / unquote(link)).exists() for link in re.findall("(?:href|src)='([^']*)'", page))


def test_names_that_the_terminal_does_not_have(tmp_path: Path) -> None:
    write_obj(tmp_path / "\u732b.obj", *grid(3))
    command = [sys.executable, "-m", "seamstress_mesh.batch", str(tmp_path / "\u732b.obj"), "-o", str(tmp_path / "out")]
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    said = subprocess.run([*command, "--no-pictures"], check=True, env=environment, capture_output=True, text=True).stdout
    assert "slowest \\u732b.obj" in said


def test_results_are_kept_where_no_picture_can_be_drawn(tmp_path: Path) -> None:
    vertices, faces = sphere()
    write_obj(tmp_path / "in" / "point.obj", 0.0 * vertices, faces)
    out = tmp_path / "out"
    main([str(tmp_path / "in"), "-o", str(out), "--quiet"])
    assert rows(out)["point.obj"]["status"] == "ok" and set(files(out)) == {"meshes/point.obj.obj"}


def test_what_cannot_be_is_an_error(meshes: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    (tmp_path / "no.csv").write_text("\ufeffsize,mesh\n3,\n")
    call = [str(meshes), "-o", str(tmp_path / "out"), "--quiet"]
    for wrong, said in (
        ([str(meshes), "-o", str(tmp_path / "file" / "out")], "file"),
        ([str(tmp_path / "no.csv"), *call[1:]], "row 1"),
        ([str(tmp_path), "-o", str(meshes.parent)], "no mesh was found"),
    ):
        assert main(wrong) == 2
        assert said in capsys.readouterr().err
    for wrong in (["--workers", "0"], ["--timeout", "-1"], ["--memory", "nan"], ["--again", "crash"], ["--task", "make"]):
        with pytest.raises(SystemExit) as ended:
            main([*call, *wrong])
        assert ended.value.code == 2 and wrong[0] in capsys.readouterr().err


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
