# SPDX-License-Identifier: GPL-3.0-or-later
"""Processes: progress, cancelling, crashes, memory. Blender goes on in each case, and nothing is left behind."""

from __future__ import annotations

import os
import pickle
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
import shapes
from seamstress import reading, running
from seamstress.jobs import Failure, Job
from seamstress.running import Queue, Task


def arguments(cuts: int = 30) -> dict[str, object]:
    """A job that takes a while."""
    mesh = shapes.cube(cuts).data
    geometry = reading.read(mesh, np.eye(3))
    return {"mesh": geometry.arrays(), "repair": False, "options": {"quads": 2000.0}, "values": []}


def begun(job: Job) -> Job:
    """A job that has told of its progress."""
    until = time.monotonic() + 60.0
    while job.progress[0] == "start" and job.is_running and time.monotonic() < until:
        time.sleep(0.005)
    assert job.is_running
    return job


def folders() -> set[Path]:
    return set(Path(tempfile.gettempdir()).glob("seamstress-*"))


def test_progress_is_told() -> None:
    job = Job("quads", **arguments(20))
    seen = set()
    while job.is_running:
        seen.add(job.progress[0])
        assert 0.0 <= job.progress[1] <= 1.0
        time.sleep(0.001)
    assert len(seen) > 1
    assert job.result()["quads"].shape[1] == 4


def test_a_cancelled_job_ends_at_once() -> None:
    before = folders()
    job = begun(Job("quads", **arguments()))
    start = time.monotonic()
    job.cancel()
    assert time.monotonic() - start < 2.0 and not job.is_running
    with pytest.raises(Failure) as failure:
        job.result()
    assert failure.value.code == "cancelled"
    assert folders() <= before


@pytest.mark.skipif(sys.platform == "win32", reason="no signals")
@pytest.mark.parametrize(
    ("sent", "said"), [("SIGSEGV", "ended unexpectedly .signal 11.; nothing was changed"), ("SIGKILL", "memory ran out")]
)
def test_a_crash_is_a_message(sent: str, said: str) -> None:
    before = folders()
    job = begun(Job("quads", **arguments()))
    os.kill(job._process.pid, getattr(signal, sent))
    with pytest.raises(Failure, match=said) as failure:
        job.result()
    assert failure.value.code == "crashed"
    assert folders() <= before


@pytest.mark.skipif(sys.platform != "linux", reason="no limits of memory")
def test_memory_that_runs_out_is_a_message() -> None:
    import resource

    job = begun(Job("quads", **{**arguments(), "options": {"quads": 50_000.0}}))
    # Less than it has: no more is to be had, and so many quads need more.
    resource.prlimit(job._process.pid, resource.RLIMIT_DATA, (2**20, 2**20))
    with pytest.raises(Failure, match="memory ran out"):
        job.result()


def test_errors_of_the_library_keep_their_code_and_findings() -> None:
    faces = np.array([0, 1, 2, 0, 1, 3, 1, 0, 4], np.int32)
    mesh = {"positions": np.eye(5)[:, :3], "sizes": np.array([3, 3, 3], np.int32), "corners": faces}
    with pytest.raises(Failure) as failure:
        Job("seamless", mesh=mesh, repair=False, options={}).result()
    assert failure.value.code == "not-a-surface"
    assert [finding["kind"] for finding in failure.value.findings] == ["non-manifold-edge"]


def test_a_queue_goes_on_after_a_crash() -> None:
    first, second = arguments(), arguments(8)
    queue = Queue([Task("a", "quads", first, lambda _: ""), Task("b", "quads", second, lambda _: "")])
    assert queue.step()
    os.kill(begun(queue._job)._process.pid, signal.SIGKILL)
    while queue.step():
        name, share = queue.progress
        assert name.startswith(("a: ", "b: ")) and 0.0 <= share <= 1.0
        time.sleep(0.01)
    (_, crashed), (_, made) = queue.outcomes
    assert isinstance(crashed, Failure) and len(made["quads"]) > 1500


def test_a_process_that_does_not_start_is_a_message(monkeypatch: pytest.MonkeyPatch) -> None:
    shapes.monkey()
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    with pytest.raises(RuntimeError, match="Suzanne: No process could be started"):
        bpy.ops.seamstress.quads(faces=500)
    assert len(bpy.data.objects) == 1


def test_a_cancelled_queue_changes_nothing() -> None:
    tasks = [Task(name, "quads", arguments(), pytest.fail) for name in "ab"]
    queue = Queue(tasks)
    queue.step()
    process = begun(queue._job)._process
    queue.cancel()
    assert process.poll() is not None
    assert not queue.step() and not queue.outcomes


#: Begins a job and ends without it.
PARENT = """
import importlib.util, os, pickle, sys, time
spec = importlib.util.spec_from_file_location("jobs", sys.argv[1])
jobs = importlib.util.module_from_spec(spec)
sys.modules["jobs"] = jobs
spec.loader.exec_module(jobs)
job = jobs.Job("quads", **pickle.loads(open(sys.argv[2], "rb").read()))
while job.progress[0] == "start":
    time.sleep(0.005)
print(job._process.pid, job._folder.name, flush=True)
os._exit(0)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="processes are told apart by signals")
def test_a_worker_ends_when_blender_does(tmp_path: Path) -> None:
    """Nobody reads what it tells any more."""
    given = tmp_path / "arguments.pickle"
    given.write_bytes(pickle.dumps(arguments()))
    jobs = Path(__file__).resolve().parents[1] / "seamstress" / "jobs.py"
    told = subprocess.run([sys.executable, "-c", PARENT, jobs, given], capture_output=True, text=True, check=True).stdout
    process, folder = told.split()
    until = time.monotonic() + 30.0
    while is_alive(int(process)) and time.monotonic() < until:
        time.sleep(0.02)
    assert not is_alive(int(process))
    assert not Path(folder, "result.pickle").exists()
    shutil.rmtree(folder)


def is_alive(process: int) -> bool:
    """Whether a process runs; one that has ended may wait for its parent to look."""
    try:
        os.kill(process, 0)
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except ProcessLookupError:
        return False
    except FileNotFoundError:
        return not Path("/proc").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="no such setting")
def test_the_system_ends_the_worker_first() -> None:
    job = begun(Job("quads", **arguments()))
    assert Path(f"/proc/{job._process.pid}/oom_score_adj").read_text().strip() == "1000"
    job.cancel()


def test_a_crash_of_an_operator_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    from seamstress import running

    class Crashing(Job):
        def __init__(self, function: str, **given: object) -> None:
            super().__init__(function, **given)
            begun(self)
            os.kill(self._process.pid, signal.SIGKILL)

    source = shapes.cube(30)
    monkeypatch.setattr(running, "Job", Crashing)
    with pytest.raises(RuntimeError, match="Cube: The work was ended, probably because memory ran out"):
        bpy.ops.seamstress.quads(faces=2000, original="REPLACE")
    assert len(source.data.polygons) == 31 * 31 * 6 and len(bpy.data.meshes) == 1


class Window:
    """Stands for a context with a window: where a modal operator says what it does."""

    def __init__(self) -> None:
        self.said: list[object] = []
        self.timers = self.handlers = 0
        self.mode, self.object, self.screen, self.window = "OBJECT", None, None, None
        self.window_manager = self.workspace = self

    def status_text_set(self, text: str | None) -> None:
        self.said.append(text)

    def event_timer_add(self, _: float, window: object) -> str:
        self.timers += 1
        return "timer"

    def event_timer_remove(self, _: str) -> None:
        self.timers -= 1

    def modal_handler_add(self, _: object) -> None:
        self.handlers += 1


class Modal(running.Running):
    """An operator without Blender's half."""

    def __init__(self, *tasks: Task) -> None:
        self.tasks, self.reports = list(tasks), []

    @classmethod
    def objects(cls, context: object) -> list[int]:
        return [0, 1]

    def result_of(self, object: int) -> int:
        return object

    def task(self, context: object, objects: list[int]) -> Task:
        return self.tasks[objects[0]]

    def report(self, kind: set[str], text: str) -> None:
        self.reports.append((kind, text))


TIMER, OTHER, ESCAPE = (SimpleNamespace(type=name, value="PRESS") for name in ("TIMER", "MOUSEMOVE", "ESC"))


def test_blender_goes_on_while_a_modal_operator_works() -> None:
    done = []
    operator = Modal(*(Task(name, "quads", arguments(20), done.append) for name in "ab"))
    window = Window()
    assert operator.begin(window) == {"RUNNING_MODAL"} and (window.timers, window.handlers) == (1, 1)
    assert running.current is not None
    while (state := operator.modal(window, TIMER)) == {"RUNNING_MODAL"}:
        assert operator.modal(window, OTHER) == {"PASS_THROUGH"}
        assert not done
        time.sleep(0.01)
    assert state == {"FINISHED"} and len(done) == 2
    assert running.current is None and window.timers == 0
    assert window.said[-1] is None and any(text.startswith("b: ") for text in window.said[:-1])
    assert [text.split(":")[0] for _, text in operator.reports] == ["a", "b"]


@pytest.mark.parametrize("by_panel", [False, True])
def test_escape_and_the_panel_stop_a_modal_operator(by_panel: bool) -> None:
    operator = Modal(*(Task(name, "quads", arguments(), pytest.fail) for name in "ab"))
    window = Window()
    operator.begin(window)
    operator.modal(window, TIMER)
    process = running.current._job._process
    if by_panel:
        assert bpy.ops.seamstress.stop() == {"FINISHED"}
    assert operator.modal(window, TIMER if by_panel else ESCAPE) == {"CANCELLED"}
    assert process.poll() is not None and running.current is None and window.timers == 0
    assert operator.reports == [({"WARNING"}, "Cancelled; nothing was changed")]


def test_one_that_was_stopped_leaves_the_next_alone() -> None:
    """The panel stops one, and another begins before the first has looked."""
    first, second = (Modal(Task(name, "quads", arguments(), lambda _: "done")) for name in "ab")
    for operator in (first, second):
        operator.objects = lambda _: [0]
    window = Window()
    first.begin(window)
    first.modal(window, TIMER)
    assert bpy.ops.seamstress.stop() == {"FINISHED"}
    second.begin(window)
    assert first.modal(window, TIMER) == {"CANCELLED"} and running.current is not None
    while (state := second.modal(window, TIMER)) == {"RUNNING_MODAL"}:
        time.sleep(0.01)
    assert state == {"FINISHED"} and running.current is None and window.timers == 0
