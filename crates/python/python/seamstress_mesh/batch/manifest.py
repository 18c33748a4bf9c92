"""The manifest: what was done, in SQLite. One process writes it; any number may read it meanwhile."""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from .inputs import printable
from .task import Limits, Outcome, Task, sha256

NAME = "manifest.sqlite"
SCHEMA = """
create table if not exists job (
    id text primary key, command text, options text, version text
) without rowid;
create table if not exists run (
    name text, job text, mesh text, size integer, mtime integer, sha256 text, output text,
    status text, code text, message text, attempts integer, seconds real, cpu_seconds real, memory_bytes integer,
    limits text, worker text, finished text, metrics text,
    primary key (name, job)
) without rowid;
"""
#: Columns of a run, in order.
COLUMNS = (
    "name job mesh size mtime sha256 output status code message attempts seconds cpu_seconds memory_bytes limits worker"
    " finished metrics"
).split()
#: How a run may end that another try, with the same limits, would not change.
LIMITED = ("time-limit", "cpu-limit", "memory-limit")
FINAL = ("ok", "refused", "no-result", "usage", *LIMITED)


@dataclass(frozen=True)
class Found:
    """A file as it is now."""

    size: int | None
    mtime: int | None

    @classmethod
    def of(cls, path: str) -> Found:
        """What is known of a file without reading it."""
        try:
            known = os.stat(path)
        except OSError:
            return cls(None, None)
        return cls(known.st_size, known.st_mtime_ns)


class Manifest:
    """The table of one folder; perhaps one that is only read."""

    def __init__(self, path: Path, is_read: bool = False) -> None:
        self.path = path
        if is_read:
            # SQLite makes a file beside it even to read it, unless told that it stays as it is.
            how = "mode=ro" if os.access(path.parent, os.W_OK) else "immutable=1"
            self._db = sqlite3.connect(f"{path.resolve().as_uri()}?{how}", uri=True)
        else:
            self._db = sqlite3.connect(path)
            self._db.execute("pragma journal_mode = wal")
            self._db.execute("pragma synchronous = normal")
            self._db.executescript(SCHEMA)
        self._db.row_factory = sqlite3.Row

    def add_job(self, job: str, command: str, options: tuple[str, ...], version: str) -> None:
        """Notes what is asked for."""
        with self._db:
            row = (job, command, json.dumps(options), version)
            self._db.execute("insert or replace into job values (?, ?, ?, ?)", row)

    def is_done(self, job: str, task: Task, again: frozenset[str]) -> bool:
        """Whether a task has a final row that is still true: of the same file, with its output, not asked for again."""
        query = "select * from run where name = ? and job = ?"
        row = self._db.execute(query, (task.name, job)).fetchone()
        if row is None or row["status"] not in FINAL or row["status"] in again or "all" in again:
            return False
        if row["status"] in LIMITED and row["limits"] != _limits(task.limits):
            return False
        output = task.output()
        if row["status"] == "ok" and output is not None and not output.exists():
            return False
        now = Found.of(task.mesh)
        if row["mesh"] == printable(task.mesh) and (row["size"], row["mtime"]) == (now.size, now.mtime):
            return True
        return now.size == row["size"] and row["sha256"] is not None and sha256(task.mesh) == row["sha256"]

    def add(self, job: str, ended: list[tuple[Task, Found, Outcome, str]]) -> None:
        """Adds rows; all of them or none."""
        rows = [self._row(job, *one) for one in ended]
        places = ", ".join("?" * len(COLUMNS))
        with self._db:
            self._db.executemany(f"insert or replace into run values ({places})", rows)

    @staticmethod
    def _row(job: str, task: Task, found: Found, outcome: Outcome, finished: str) -> tuple[Any, ...]:
        output = task.output() if outcome.status == "ok" else None
        values = {
            **asdict(outcome),
            "name": task.name,
            "job": job,
            "mesh": printable(task.mesh),
            "size": found.size,
            "mtime": found.mtime,
            "output": output and str(output.relative_to(task.folder)),
            "attempts": task.attempts + 1,
            "limits": _limits(task.limits),
            "finished": finished,
            "metrics": json.dumps(outcome.metrics, separators=(",", ":")),
        }
        return tuple(values[column] for column in COLUMNS)

    def rows(self, job: str) -> Iterator[dict[str, Any]]:
        """The rows of a job by name, with their metrics."""
        for row in self._db.execute("select * from run where job = ? order by name", (job,)):
            yield {**row, "metrics": json.loads(row["metrics"])}

    def jobs(self) -> list[dict[str, Any]]:
        """The jobs, the one finished last at the end."""
        query = "select job.* from job left join run on run.job = job.id group by job.id order by max(run.finished)"
        return [dict(row) for row in self._db.execute(query)]

    def counts(self, job: str) -> dict[str, int]:
        """How many rows of a job have each status."""
        query = "select status, count(*) from run where job = ? group by status order by status"
        return dict(tuple(row) for row in self._db.execute(query, (job,)))

    def close(self) -> None:
        """Closes the file."""
        self._db.close()


def _limits(limits: Limits) -> str:
    return json.dumps(asdict(limits))
