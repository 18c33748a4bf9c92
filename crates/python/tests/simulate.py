"""What the driver of a large data set costs, without the work itself: ``python crates/python/tests/simulate.py 1000000``.

Runs the driver with an engine that gives the row of one mesh for every task at once, then again with nothing to do, and
writes the table, the summary and the pages.
"""

from __future__ import annotations

import resource
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from conftest import ROOT

from seamstress_mesh.batch import driver, export, pages
from seamstress_mesh.batch.manifest import NAME, Manifest
from seamstress_mesh.batch.task import Outcome, Task, run

#: Tasks that the engine has at a time.
CAPACITY = 64
#: Meshes in a folder.
FOLDER = 1000


class Instant:
    """An engine whose tasks end at once, all with one outcome."""

    capacity = CAPACITY

    def __init__(self, outcome: Outcome) -> None:
        self._outcome = outcome
        self._flying: list[Task] = []

    def submit(self, task: Task) -> None:
        self._flying.append(task)

    def done(self, seconds: float) -> Iterator[tuple[Task, Outcome]]:
        flying, self._flying = self._flying, []
        for task in flying:
            yield task, replace(self._outcome)

    def close(self) -> None:
        pass


def stand_in(folder: Path, count: int) -> None:
    """Results of all meshes; each folder is the same one, so that a million need no room."""
    results = folder / "all"
    results.mkdir(parents=True, exist_ok=True)
    for k in range(min(count, FOLDER)):
        (results / f"{k}.obj.obj").touch()
    for k in range(-(-count // FOLDER)):
        (folder / str(k)).symlink_to(results)


def main() -> None:
    """Prints what each part costs."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    mesh = str(ROOT / "samples" / "bracket.obj")
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        options = ("--quads", "500")
        one = run(Task(mesh, "one", "quad", options, temporary, False))
        assert one.status == "ok", one

        def report(what: str, start: float) -> None:
            seconds = time.process_time() - start
            print(f"{what:<44}{seconds:>9.1f} s{1e3 * seconds / count:>9.3f} ms a mesh", flush=True)

        start = time.process_time()
        names = [f"{k // FOLDER}/{k % FOLDER}.obj" for k in range(count)]
        tasks = [Task(mesh, name, "quad", options, temporary, False) for name in names]
        report("tasks", start)
        stand_in(folder / "meshes", count)

        manifest = Manifest(folder / NAME)
        job = driver.job_id("quad", options, "simulated")
        manifest.add_job(job, "quad", options, "simulated")
        start = time.process_time()
        todo = driver.missing(manifest, job, tasks, frozenset())
        assert len(todo) == count
        report("what is to do, of an empty manifest", start)
        start = time.process_time()
        driver.work(manifest, job, todo, Instant(one), 2, driver.Progress(count, True))
        report("handing out, and writing rows", start)
        size = (folder / NAME).stat().st_size
        print(f"{'manifest':<44}{size / 1e9:>9.2f} GB{size / count / 1e3:>9.2f} kB a mesh", flush=True)

        start = time.process_time()
        assert not driver.missing(manifest, job, tasks, frozenset())
        report("what is to do, of a full manifest", start)
        start = time.process_time()
        table = export.write(manifest, job, folder)
        report(f"{table.name}, {table.stat().st_size / 1e9:.2f} GB", start)
        start = time.process_time()
        export.summary(manifest, job, set(names))
        report("summary", start)
        start = time.process_time()
        pages.write(manifest, job, folder, "simulated")
        report("pages", start)
        manifest.close()
    print(f"{'most memory':<44}{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:>9.2f} GB")


if __name__ == "__main__":
    main()
