"""Engines: who runs the tasks. Each takes some tasks at a time and gives outcomes back as they come."""

from __future__ import annotations

import logging
import os
import queue
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Protocol

from .task import Interrupted, Outcome, Task, run

#: Tasks that wait at each worker, so that it never does.
AHEAD = 2


class EngineError(Exception):
    """An engine that cannot be had."""


class Engine(Protocol):
    """Runs tasks."""

    #: How many tasks it wants to have at a time.
    capacity: int

    def submit(self, task: Task) -> None:
        """Takes a task."""

    def done(self, seconds: float) -> Iterator[tuple[Task, Outcome]]:
        """The tasks that have ended since, after at most so many seconds."""

    def close(self) -> None:
        """Ends all that still runs."""


class Local:
    """Processes of this machine; a thread waits for each."""

    def __init__(self, workers: int) -> None:
        self.capacity = AHEAD * workers
        self._ended: queue.SimpleQueue[tuple[Task, Outcome]] = queue.SimpleQueue()
        self._pool = ThreadPoolExecutor(workers)
        self._closed = threading.Event()

    def submit(self, task: Task) -> None:
        self._pool.submit(self._run, task)

    def _run(self, task: Task) -> None:
        try:
            outcome = run(task, self._closed.is_set)
        except Interrupted:
            return
        except Exception as error:  # A full disk, a folder that is gone.
            outcome = Outcome("crashed", type(error).__name__, str(error))
        self._ended.put((task, outcome))

    def done(self, seconds: float) -> Iterator[tuple[Task, Outcome]]:
        try:
            yield self._ended.get(timeout=seconds)
            while True:
                yield self._ended.get_nowait()
        except queue.Empty:
            return

    def close(self) -> None:
        self._closed.set()
        self._pool.shutdown(cancel_futures=True)


class Ray:
    """Workers of a Ray cluster, or of one that is started here. Results have to be in a folder that all of them see."""

    def __init__(self, workers: int, address: str | None) -> None:
        # Its workers are nice to others by default, and slow.
        os.environ.setdefault("RAY_worker_niceness", "0")
        try:
            import ray
        except ImportError:
            raise EngineError("the engine `ray` needs Ray: pip install seamstress-mesh[ray]") from None
        self._ray = ray
        started: dict[str, Any] = {"address": address} if address else {"num_cpus": workers, "include_dashboard": False}
        ray.init(log_to_driver=False, logging_level=logging.ERROR, **started)
        # The driver itself tries again, and counts.
        self._remote = ray.remote(num_cpus=1, max_retries=0)(run)
        self.capacity = AHEAD * workers
        self._flying: dict[Any, Task] = {}

    def submit(self, task: Task) -> None:
        self._flying[self._remote.remote(task)] = task

    def done(self, seconds: float) -> Iterator[tuple[Task, Outcome]]:
        ready, _ = self._ray.wait(list(self._flying), num_returns=1, timeout=seconds)
        for reference in ready:
            task = self._flying.pop(reference)
            try:
                yield task, self._ray.get(reference)
            except (self._ray.exceptions.RayError, OSError) as error:
                yield task, Outcome("crashed", type(error).__name__, str(error)[:200])

    def close(self) -> None:
        self._ray.shutdown()


def engine(name: str, workers: int, address: str | None) -> Engine:
    """The engine of a name."""
    return Ray(workers, address) if name == "ray" else Local(workers)
