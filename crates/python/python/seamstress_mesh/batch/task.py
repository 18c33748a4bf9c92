"""One task: the command on one mesh, in a process of its own. Needs only the standard library, on any machine."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import signal
import socket
import stat
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

#: How the tasks are called on the command line, with what they write and how they draw it.
OUTPUTS = {"map": ".obj", "quad": ".obj", "integer": ".obj", "extract": ".obj", "check": None, "features": None, "quality": None}
PICTURES = {"map": "--pictures", "integer": "--pictures", "quad": "--picture", "features": "--picture", "quality": "--picture"}
#: Commands that take no limits and run on one thread.
QUICK = {"check", "features", "quality"}
#: What an exit code of the command stands for.
STATUS = {0: "ok", 1: "refused", 2: "usage", 3: "no-result", 4: "time-limit"}
#: Time that the command has to end on its own after its time limit.
GRACE = 5.0
#: The code of a picture that cannot be drawn, as of a mesh that is a point: the result is worth having without.
NO_PICTURE = "no-picture"
#: What the system says where a file does not fit into memory.
OUT_OF_MEMORY = "out of memory"
#: The end of what the command has said that is kept.
LONGEST_MESSAGE = 2000
#: Bytes that are hashed at once.
BLOCK = 1 << 20


@dataclass(frozen=True)
class Limits:
    """What a task may use."""

    #: Seconds by the clock.
    timeout: float | None = None
    #: Seconds of computation.
    cpu: float | None = None
    #: Bytes of memory.
    memory: float | None = None


@dataclass(frozen=True)
class Task:
    """One mesh, and what to do with it."""

    #: The mesh.
    mesh: str
    #: Its name in the manifest, and of its files without their endings.
    name: str
    #: The command.
    command: str
    #: Its options.
    options: tuple[str, ...]
    #: Where results go.
    folder: str
    #: Whether to draw a picture.
    picture: bool = True
    limits: Limits = Limits()
    #: How often it was tried before.
    attempts: int = 0

    def output(self) -> Path | None:
        """The file that is made."""
        suffix = OUTPUTS[self.command]
        return Path(self.folder, "meshes", self.name + suffix) if suffix else None

    def drawn(self) -> Path | None:
        """The picture that is made."""
        is_drawn = self.picture and self.command in PICTURES
        return Path(self.folder, "pictures", self.name + ".png") if is_drawn else None


@dataclass
class Outcome:
    """What became of a task."""

    #: ``ok``, ``refused``, ``no-result``, ``usage``; ``time-limit``, ``cpu-limit``, ``memory-limit``; ``crashed``.
    status: str
    #: The stable code of the error, or the signal.
    code: str | None = None
    message: str | None = None
    #: Of the input.
    sha256: str | None = None
    seconds: float = 0.0
    cpu_seconds: float | None = None
    memory_bytes: int | None = None
    worker: str = field(default_factory=lambda: f"{socket.gethostname()}:{os.getpid()}")
    #: All numbers and words of the report, by their paths in it.
    metrics: dict[str, Any] = field(default_factory=dict)


class Interrupted(Exception):
    """Stopped from outside."""


def run(task: Task, is_stopped: Callable[[], bool] = lambda: False) -> Outcome:
    """Runs a task. Results appear in their places when it has succeeded; what it leaves else is removed.

    Raises ``Interrupted`` soon after it is stopped.
    """
    start = time.monotonic()
    work = Path(task.folder, ".work", f"{hashlib.sha256(task.name.encode()).hexdigest()[:16]}-{os.getpid()}")
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    try:
        digest = sha256(task.mesh)
        outcome = _command(task, work, is_stopped)
        outcome.sha256 = digest
    finally:
        shutil.rmtree(work, ignore_errors=True)
    outcome.seconds = time.monotonic() - start
    return outcome


def sha256(path: str) -> str | None:
    """The hash of a file; none of what cannot be read, or is no file."""
    digest = hashlib.sha256()
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            return None
        with open(path, "rb") as file:
            while block := file.read(BLOCK):
                digest.update(block)
    except OSError:
        return None
    return digest.hexdigest()


def _command(task: Task, work: Path, is_stopped: Callable[[], bool]) -> Outcome:
    limits, output, drawn = task.limits, task.output(), task.drawn()
    arguments = [task.command, task.mesh, *task.options, "--json"]
    if task.command not in QUICK:
        arguments += ["--quiet", "--threads", "1"]
        arguments += ["--time-limit", str(limits.timeout)] if limits.timeout else []
    made = work / ("made" + (output.suffix if output else ""))
    if output:
        arguments += ["-o", str(made)]
    flag = PICTURES.get(task.command)
    picture = work / "picture.png"
    if drawn and flag:
        arguments += [flag, str(work if flag == "--pictures" else picture)]
        picture = work / "front.png" if flag == "--pictures" else picture
    outcome, report = _process(arguments, limits, work, is_stopped)
    error = report.pop("error", None)
    if isinstance(error, dict):
        outcome.code = error.get("code")
        if outcome.code == NO_PICTURE and drawn:
            return _command(replace(task, picture=False), work, is_stopped)
        if outcome.code == "memory-limit":
            outcome.status = "memory-limit"
        if outcome.status == "refused" and OUT_OF_MEMORY in (error.get("message") or ""):
            # While the input was read: not its fault.
            outcome.status = "memory-limit"
    if outcome.status == "ok":
        for source, place in ((picture, drawn), (made, output)):
            if place and source.exists():
                place.parent.mkdir(parents=True, exist_ok=True)
                os.replace(source, place)
    outcome.metrics = dict(flat(report))
    outcome.memory_bytes = outcome.metrics.get("cost.peak_memory_bytes", outcome.memory_bytes)
    return outcome


def _process(
    arguments: list[str], limits: Limits, work: Path, is_stopped: Callable[[], bool]
) -> tuple[Outcome, dict[str, Any]]:
    """Runs the command; how it ended, and its report."""
    bounds = json.dumps({"cpu": limits.cpu, "memory": limits.memory, "parent": os.getpid()})
    script = Path(__file__).resolve().parents[1] / "_command.py"
    command = [sys.executable, "-I", "-S", str(script), bounds, *arguments]
    said, report = work / "said.txt", work / "report.json"
    with open(said, "wb") as errors, open(report, "wb") as out:
        child = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=out, stderr=errors, start_new_session=True, cwd=os.getcwd()
        )
    try:
        ended, cpu, memory = _wait(child, limits.timeout, is_stopped)
    except BaseException:
        kill(child)
        raise
    message = said.read_text(encoding="utf-8", errors="replace")[-LONGEST_MESSAGE:].strip() or None
    status, code = _status(ended, message or "")
    try:
        read = json.loads(report.read_text(encoding="utf-8"))
    except ValueError:
        read = {}
    outcome = Outcome(status, code, None if status == "ok" else message, cpu_seconds=cpu, memory_bytes=memory)
    return outcome, read


def _wait(
    child: subprocess.Popen[bytes], timeout: float | None, is_stopped: Callable[[], bool]
) -> tuple[int | None, float | None, int | None]:
    """Exit code (a signal is negative, none is out of time), seconds of computation and peak memory."""
    deadline = None if timeout is None else time.monotonic() + timeout + GRACE
    pause = 0.001
    while True:
        if hasattr(os, "wait4"):
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
            if pid:
                child.returncode = os.waitstatus_to_exitcode(status)
                return child.returncode, usage.ru_utime + usage.ru_stime, _peak(usage.ru_maxrss)
        elif child.poll() is not None:
            return child.returncode, None, None
        if deadline is not None and time.monotonic() > deadline:
            kill(child)
            return None, None, None
        if is_stopped():
            raise Interrupted
        time.sleep(pause)
        pause = min(0.05, 1.5 * pause)


def _peak(of_child: int) -> int | None:
    """Peak memory of a child that has ended, bytes. It begins with what its parent had, and is not known below that."""
    import resource

    unit = 1 if sys.platform == "darwin" else 1024
    return of_child * unit if of_child > resource.getrusage(resource.RUSAGE_SELF).ru_maxrss else None


def kill(child: subprocess.Popen[bytes]) -> None:
    """Ends a child and all that it has started."""
    try:
        if hasattr(os, "killpg"):
            os.killpg(child.pid, signal.SIGKILL)
        else:
            child.kill()
    except ProcessLookupError:
        pass
    child.wait()


def _status(ended: int | None, message: str) -> tuple[str, str | None]:
    if ended is None:
        return "time-limit", "hang"
    if ended >= 0:
        return STATUS.get(ended, "crashed"), None if ended in STATUS else f"exit {ended}"
    name = signal.Signals(-ended).name
    if name == "SIGXCPU":
        return "cpu-limit", name
    if name == "SIGABRT" and "memory allocation" in message:
        return "memory-limit", name
    return "crashed", name


def flat(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """The numbers and words of a report, by their paths in it; of lists only their lengths."""
    if isinstance(value, dict):
        for name, part in value.items():
            yield from flat(part, f"{path}.{name}" if path else name)
    elif isinstance(value, list):
        yield f"{path}.count", len(value)
    elif value is not None:
        yield path, value
