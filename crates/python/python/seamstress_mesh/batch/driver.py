"""The driver: what is missing is run, and stands in the manifest when it is done."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from datetime import datetime, timezone
from pathlib import Path

from .engines import Engine
from .manifest import Found, Manifest
from .task import Outcome, Task

#: How often the manifest is written, at most; seconds.
COMMIT = 0.5
#: How often progress is shown: on a terminal, and in a log.
SHOWN, LOGGED = 0.5, 30.0


def version() -> str:
    """The version of the package, and the hash of its compiled half."""
    from .. import _native

    build = hashlib.sha256(Path(_native.__file__).read_bytes()).hexdigest()[:12]
    return f"{_native.__version__}+{build}"


def job_id(command: str, options: tuple[str, ...], version: str) -> str:
    """What is asked for, in short: other options or another version are another job."""
    return hashlib.sha256(json.dumps([command, options, version]).encode()).hexdigest()[:12]


@contextlib.contextmanager
def alone(folder: Path) -> Iterator[None]:
    """Keeps a folder to this process: there is one writer. The system ends the lock with the process."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / ".lock", "w") as lock:
        try:
            import fcntl

            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except ImportError:
            pass
        except OSError:
            raise SystemExit(f"error: another process works on {folder}") from None
        # What a process that was killed has left.
        shutil.rmtree(folder / ".work", ignore_errors=True)
        yield


@dataclass
class Progress:
    """Counts, rate and time left, on one line."""

    total: int
    quiet: bool
    done: int = 0
    failed: int = 0
    start: float = 0.0
    shown: float = 0.0

    def add(self, outcomes: Iterable[Outcome]) -> None:
        """Counts outcomes."""
        for outcome in outcomes:
            self.done += 1
            self.failed += outcome.status != "ok"
        now = time.monotonic()
        is_terminal = sys.stderr.isatty()
        is_due = now - self.shown > (SHOWN if is_terminal else LOGGED) or self.done == self.total
        if not self.quiet and is_due:
            self.shown = now
            end = "\r" if is_terminal and self.done < self.total else "\n"
            print(self.line(now - self.start), end=end, file=sys.stderr, flush=True)

    def line(self, seconds: float) -> str:
        """How far it is after so many seconds."""
        rate = self.done / max(seconds, 1e-9)
        left = (self.total - self.done) / rate if self.done else float("inf")
        return f"{self.done}/{self.total} done, {self.failed} not ok, {rate:.3g} a second, {duration(left)} left   "


def duration(seconds: float) -> str:
    """A time for people."""
    if seconds == float("inf"):
        return "unknown time"
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


def missing(manifest: Manifest, job: str, tasks: Iterable[Task], again: frozenset[str]) -> list[Task]:
    """The tasks that are not done, the largest first, which evens out the end."""
    todo = [task for task in tasks if not manifest.is_done(job, task, again)]
    return sorted(todo, key=lambda task: -(Found.of(task.mesh).size or 0))


def work(
    manifest: Manifest, job: str, tasks: list[Task], engine: Engine, retries: int, progress: Progress
) -> None:
    """Runs tasks. Crashes are tried again; all else is final."""
    progress.start = time.monotonic()
    waiting, flying = list(reversed(tasks)), 0
    ended: list[tuple[Task, Found, Outcome, str]] = []
    committed = time.monotonic()
    try:
        while waiting or flying:
            while waiting and flying < engine.capacity:
                engine.submit(waiting.pop())
                flying += 1
            new = []
            for task, outcome in engine.done(COMMIT):
                flying -= 1
                if outcome.status == "crashed" and task.attempts < retries:
                    waiting.append(replace(task, attempts=task.attempts + 1))
                    continue
                finished = datetime.now(timezone.utc).isoformat(timespec="milliseconds")
                new.append((task, Found.of(task.mesh), outcome, finished))
            ended += new
            if ended and (time.monotonic() - committed > COMMIT or not flying):
                manifest.add(job, ended)
                ended, committed = [], time.monotonic()
            progress.add(outcome for _, _, outcome, _ in new)
    finally:
        # What has ended is kept also when this is stopped.
        if ended:
            manifest.add(job, ended)
