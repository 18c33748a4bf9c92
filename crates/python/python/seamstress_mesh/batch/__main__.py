"""``python -m seamstress_mesh.batch``."""

from __future__ import annotations

import argparse
import io
import os
import sqlite3
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import compare, driver, export, pages
from .engines import EngineError, engine
from .inputs import InputsError, find
from .manifest import FINAL, NAME, Manifest
from .task import OUTPUTS, Limits, Task

EPILOG = """\
Options of the command stand after `--`:

  python -m seamstress_mesh.batch meshes -o out --task quad --workers 8 --timeout 600 -- --quads 2000
  python -m seamstress_mesh.batch meshes -o out --task quad --again crashed -- --quads 2000
  python -m seamstress_mesh.batch meshes -o new --task map --compare old
"""


def positive(kind: Callable[[str], float]) -> Callable[[str], Any]:
    """Numbers larger than 0."""

    def read(text: str) -> float:
        number = kind(text)
        if not 0 < number < float("inf"):
            raise ValueError
        return number

    read.__name__ = "number larger than 0"
    return read


def parser() -> argparse.ArgumentParser:
    """The arguments."""
    made = argparse.ArgumentParser(
        prog="python -m seamstress_mesh.batch",
        description="Run a command over many meshes, each in a process of its own. What is done is not done again.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    made.add_argument(
        "inputs",
        nargs="+",
        metavar="IN",
        help="folders, meshes, patterns, lists (.txt), tables (.csv, .tsv, .parquet) with a column `mesh` or `path`",
    )
    made.add_argument("-o", "--output", required=True, type=Path, metavar="DIR", help="the folder of results")
    made.add_argument("--task", choices=sorted(OUTPUTS), default="map", help="the command to run [default: map]")
    made.add_argument("--engine", choices=["local", "ray"], default="local", help="who runs it [default: local]")
    made.add_argument("--workers", type=positive(int), metavar="N", help="meshes at a time [default: all cores]")
    made.add_argument("--address", help="of a Ray cluster [default: one is started here]")
    made.add_argument("--timeout", type=positive(float), metavar="S", help="seconds that a mesh may take")
    made.add_argument("--cpu-limit", type=positive(float), metavar="S", help="seconds of computation that a mesh may take")
    made.add_argument("--memory", type=positive(float), metavar="GB", help="memory that a mesh may take")
    made.add_argument("--retries", type=int, default=2, metavar="N", help="further tries after a crash [default: 2]")
    made.add_argument(
        "--again", action="append", default=[], metavar="STATUS", choices=[*FINAL, "crashed", "all"],
        help="do those of a status again, or `all`",
    )
    made.add_argument("--no-pictures", action="store_true", help="draw no pictures")
    made.add_argument("--compare", type=Path, metavar="OLD", help="say what is better or worse than in this folder")
    made.add_argument("--quiet", action="store_true", help="show no progress")
    return made


def main(arguments: list[str] | None = None) -> int:
    """Runs a batch; 0 if all are done, whatever came out, and 1 if some are not."""
    given = sys.argv[1:] if arguments is None else arguments
    split = given.index("--") if "--" in given else len(given)
    options, asked = tuple(given[split + 1 :]), parser().parse_args(given[:split])
    try:
        meshes = find(asked.inputs, asked.output)
        if not meshes:
            raise InputsError("no mesh was found outside of the folder of results")
        return run(asked, options, meshes)
    except (InputsError, EngineError, OSError, sqlite3.Error) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


def run(asked: argparse.Namespace, options: tuple[str, ...], meshes: dict[str, str]) -> int:
    """Runs what is missing, and says what came out."""
    workers = asked.workers or os.cpu_count() or 1
    limits = Limits(asked.timeout, asked.cpu_limit, asked.memory and 1e9 * asked.memory)
    folder: Path = asked.output.resolve()
    version = driver.version()
    job = driver.job_id(asked.task, options, version)
    tasks = [
        Task(mesh, name, asked.task, options, str(folder), not asked.no_pictures, limits) for name, mesh in meshes.items()
    ]
    with driver.alone(folder):
        manifest = Manifest(folder / NAME)
        manifest.add_job(job, asked.task, options, version)
        todo = driver.missing(manifest, job, tasks, frozenset(asked.again))
        print(f"{len(tasks)} meshes, {len(tasks) - len(todo)} done before, {len(todo)} to do", file=sys.stderr)
        is_complete = True
        if todo:
            running = engine(asked.engine, min(workers, len(todo)), asked.address)
            try:
                driver.work(manifest, job, todo, running, asked.retries, driver.Progress(len(todo), asked.quiet))
            except KeyboardInterrupt:
                print("\nstopped; the same command goes on from here", file=sys.stderr)
                is_complete = False
            finally:
                running.close()
        names = {task.name for task in tasks}
        written = export.write(manifest, job, folder)
        page = pages.write(manifest, job, folder, f"{asked.task} {' '.join(options)}")
        print(export.summary(manifest, job, names))
        print(f"{'written':<13}{written}, {page}")
        if asked.compare:
            print(compare.text(asked.compare, manifest, job))
        manifest.close()
    return 0 if is_complete else 1


if __name__ == "__main__":
    for stream in (sys.stdout, sys.stderr):
        # Names of meshes may have letters that the terminal does not.
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    sys.exit(main())
