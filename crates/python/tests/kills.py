"""Kills tasks, workers and drivers of a data set at random moments, and compares it with one that was left alone.

    python crates/python/tests/kills.py MESHES... [--engine local ray] [--kills 3] [--plant] -o FOLDER -- ARGUMENTS OF THE BATCH

For each engine the data set is run once more under fire. ``--kills`` tasks, as many workers of the engine (``ray`` alone
has workers that are processes) and as many drivers get SIGKILL; after a driver the same command is run again. At the end
the table has to be that of the run that was left alone, all files have to be the same, and nothing may be left: no
process, no half file. ``--plant`` adds an input that never ends and one that is 30 GB large when it is unpacked. Linux.
"""

from __future__ import annotations

import argparse
import gzip
import os
import random
import signal
import subprocess
import sys
import time
import uuid
from pathlib import Path
from typing import Any

from seamstress_mesh.batch.manifest import NAME, Manifest

#: Columns and metrics that vary from run to run.
VARY = {"seconds", "cpu_seconds", "memory_bytes", "worker", "finished", "attempts"}
COSTS = ("cost.", "seconds", "files.")
#: In the environment of all processes of a run, by which they are found.
MARK = "SEAMSTRESS_KILLS"
#: Time that an engine has to end its processes, seconds.
CLEARED = 30.0
#: What Ray leaves when a driver is killed: two processes that report that to a server which has ended too, and then end.
AGENTS = ("ray::DashboardAgent", "ray::RuntimeEnvAgent")
#: Time for these.
AGENTS_CLEARED = 180.0
#: The moments lie within this share of the time of the run that was left alone.
WITHIN = 0.7
#: How often a data set is run at most, until all kills are done.
PASSES = 5
#: What is planted.
ENDLESS, HOG = "endless.obj", "hog.obj.gz"


def rows(folder: Path) -> dict[str, dict[str, Any]]:
    """The rows of the job that was run last, by name."""
    manifest = Manifest(folder / NAME)
    found = {row["name"]: row for row in manifest.rows(manifest.jobs()[-1]["id"])}
    manifest.close()
    return found


def table(folder: Path) -> dict[str, Any]:
    """What has to be the same in every run: all but costs and who bore them."""

    def same(row: dict[str, Any]) -> dict[str, Any]:
        metrics = {k: v for k, v in row["metrics"].items() if not any(cost in k for cost in COSTS)}
        return {**{k: v for k, v in row.items() if k not in VARY}, "metrics": metrics}

    return {name: same(row) for name, row in rows(folder).items()}


def files(folder: Path) -> dict[str, bytes]:
    """All results, by their names."""
    kinds = ("meshes", "pictures")
    found = [path for kind in kinds for path in (folder / kind).rglob("*") if path.is_file()]
    return {str(path.relative_to(folder)): path.read_bytes() for path in found}


def leftovers(folder: Path) -> list[Path]:
    """What a run has left beside its results."""
    work = folder / ".work"
    return [*work.rglob("*"), *folder.glob(".results*"), *folder.glob(".index*")]


def plant(folder: Path, size: float) -> None:
    """An input that never ends, and one that is so large when it is unpacked."""
    folder.mkdir(parents=True, exist_ok=True)
    os.mkfifo(folder / ENDLESS)
    block = b"v 0 0 0\n" * (1 << 23)
    packed = gzip.compress(block)
    with open(folder / HOG, "wb") as file:
        for _ in range(int(size / len(block)) + 1):
            file.write(packed)


def processes(mark: str) -> dict[int, tuple[int, str]]:
    """All processes with a mark, with their parents and commands; without those that have ended."""
    found = {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if f"{MARK}={mark}".encode() not in (folder / "environ").read_bytes().split(b"\0"):
                continue
            state, parent = (folder / "stat").read_text().rpartition(")")[2].split()[:2]
            command = (folder / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace").strip()
        except OSError:
            continue
        if state != "Z":
            found[int(folder.name)] = (int(parent), command)
    return found


class Run:
    """A run of a data set, and its processes."""

    def __init__(self, arguments: list[str]) -> None:
        self.mark = uuid.uuid4().hex
        command = [sys.executable, "-m", "seamstress_mesh.batch", *arguments]
        self.driver = subprocess.Popen(
            command, env={**os.environ, MARK: self.mark}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )

    def victims(self, kind: str) -> list[int]:
        """What can be killed now: processes of tasks, workers that have one, or the driver."""
        tasks = {pid: parent for pid, (parent, command) in processes(self.mark).items() if "_command.py" in command}
        found = {"task": list(tasks), "worker": list(tasks.values()), "driver": [self.driver.pid] if tasks else []}
        return found[kind]

    def is_running(self) -> bool:
        """Whether the driver is."""
        return self.driver.poll() is None

    def left(self, seconds: float, but: tuple[str, ...] = ()) -> dict[int, tuple[int, str]]:
        """The processes but some that are left this long after the driver has ended."""
        deadline = time.monotonic() + seconds
        while left := {pid: one for pid, one in processes(self.mark).items() if not one[1].startswith(but)}:
            if time.monotonic() > deadline:
                break
            time.sleep(0.1)
        return left


def under_fire(arguments: list[str], kinds: list[str], seconds: float, chance: random.Random) -> tuple[list[Run], list[str]]:
    """Runs a data set while victims of these kinds are killed, at moments within a time; all runs, and what went wrong."""
    runs: list[Run] = []
    pending = list(kinds)
    for _ in range(PASSES):
        # Where it was faster than thought, all is done again under the fire that is left.
        again = ["--again", "all"] if runs else []
        seconds = _pass(arguments, again, pending, seconds, chance, runs)
        if not pending:
            break
    code = runs[-1].driver.returncode
    faults = [f"the last driver ended with {code}"] if code else []
    faults += [f"the run ended before {len(pending)} of the kills"] if pending else []
    for run in runs:
        if left := run.left(CLEARED, AGENTS):
            faults.append(f"processes are left: {left}")
    return runs, faults


def _pass(
    arguments: list[str], again: list[str], pending: list[str], seconds: float, chance: random.Random, runs: list[Run]
) -> float:
    """Runs a data set to its end, killing what is pending; the time in which there were tasks."""
    moments = sorted(chance.uniform(0.0, WITHIN * seconds) for _ in pending)
    runs.append(Run([*again, *arguments]))
    working, last = 0.0, time.monotonic()
    while (run := runs[-1]).is_running():
        time.sleep(0.03)
        now = time.monotonic()
        working, last = working + (now - last if run.victims("task") else 0.0), now
        if not pending or working < moments[0] or not (victims := run.victims(pending[0])):
            continue
        victim = chance.choice(victims)
        try:
            os.kill(victim, signal.SIGKILL)
        except ProcessLookupError:
            continue
        moments.pop(0)
        kind = pending.pop(0)
        print(f"  after {working:.1f} s of work: killed a {kind}, {victim}", flush=True)
        if kind == "driver":
            run.driver.wait()
            runs.append(Run(arguments))
    return working


def differences(undisturbed: Path, out: Path) -> list[str]:
    """What a run differs in from one that was left alone, and what it has left."""
    ours, theirs = table(out), table(undisturbed)
    found = [f"only in one table: {sorted(set(ours) ^ set(theirs))}"] if set(ours) != set(theirs) else []
    for name in set(ours) & set(theirs):
        differing = [key for key in theirs[name] if ours[name][key] != theirs[name][key]]
        if differing:
            shown = {key: (theirs[name][key], ours[name][key]) for key in differing if key != "metrics"}
            found.append(f"{name} differs in {differing}: {shown}")
    ours, theirs = files(out), files(undisturbed)
    found += [f"file {name} differs" for name in sorted(set(ours) | set(theirs)) if ours.get(name) != theirs.get(name)]
    return found + [f"{path} is left" for path in leftovers(out)]


def demonstrate(
    meshes: list[str], engines: list[str], kills: int, folder: Path, seed: int, options: list[str]
) -> tuple[list[Run], list[str]]:
    """Runs a data set alone and, on each engine, under fire; all runs, and what went wrong."""
    split = options.index("--") if "--" in options else len(options)

    def arguments(engine: str, out: Path) -> list[str]:
        head = [*meshes, "-o", str(out), "--engine", engine, "--quiet", "--retries", "9"]
        return [*head, *options[:split], *options[split:]]

    undisturbed, chance = folder / "undisturbed", random.Random(seed)
    start = time.monotonic()
    alone = Run(arguments("local", undisturbed))
    faults = [] if alone.driver.wait() == 0 else ["the run that was left alone failed"]
    runs = [alone]
    seconds = time.monotonic() - start
    counts: dict[str, int] = {}
    for row in rows(undisturbed).values():
        counts[row["status"]] = counts.get(row["status"], 0) + 1
    print(f"left alone: {seconds:.0f} s, {sum(counts.values())} rows, {counts}", flush=True)
    for engine in engines:
        kinds = ["task", "driver"] * kills + (["worker"] * kills if engine == "ray" else [])
        chance.shuffle(kinds)
        out, start = folder / engine, time.monotonic()
        print(f"{engine}, {len(kinds)} kills:", flush=True)
        more, here = under_fire(arguments(engine, out), kinds, seconds, chance)
        here += differences(undisturbed, out)
        runs += more
        tried = sum(row["attempts"] > 1 for row in rows(out).values())
        end = "the same table and files, nothing left" if not here else f"{len(here)} faults"
        print(f"  {time.monotonic() - start:.0f} s, {tried} rows tried again: {end}", flush=True)
        faults += [f"{engine}: {fault}" for fault in here]
    return runs, faults


def main() -> int:
    """Runs the demonstration; 1 if anything went wrong."""
    split = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("-o", "--output", required=True, type=Path)
    parser.add_argument("--engine", nargs="+", default=["local", "ray"], choices=["local", "ray"])
    parser.add_argument("--kills", type=int, default=3)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--plant", action="store_true")
    asked = parser.parse_args(sys.argv[1:split])
    meshes = list(asked.meshes)
    if asked.plant:
        plant(asked.output / "planted", 30e9)
        meshes.append(str(asked.output / "planted"))
    runs, faults = demonstrate(meshes, asked.engine, asked.kills, asked.output, asked.seed, sys.argv[split + 1 :])
    if asked.plant:
        for engine in ("undisturbed", *asked.engine):
            status = {name: rows(asked.output / engine)[name]["status"] for name in (ENDLESS, HOG)}
            print(f"{engine}: {status}")
            if status != {ENDLESS: "time-limit", HOG: "memory-limit"}:
                faults.append(f"{engine}: what was planted ended as {status}")
    faults += [f"processes are left: {left}" for run in runs if (left := run.left(AGENTS_CLEARED))]
    print("\n".join(faults) if faults else "all as it should be")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
