"""What the package costs beside the library: ``python crates/python/tests/overhead.py MESH [PAIRS]``.

First its own work is measured: arrays to what the library takes, and results to arrays. Then the map is made through the
package and through the command by turns, each in a process of its own on one thread, and computation is compared. Linux,
macOS.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import Callable

import seamstress_mesh as sm
from seamstress_mesh import _arrays
from seamstress_mesh._results import SeamlessMap

#: How often the package's own work is measured.
TIMES = 5
THROUGH_PACKAGE = """
import sys, seamstress_mesh as sm
sm.read(sys.argv[1]).parametrize(threads=1).write(sys.argv[2])
"""


def seconds(work: Callable[[], object]) -> float:
    """Computation, the median of some times."""
    found = []
    for _ in range(TIMES):
        start = time.process_time()
        work()
        found.append(time.process_time() - start)
    return median(found)


def of_process(*command: str) -> float:
    """Computation of a process."""
    child = subprocess.Popen(command)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    assert child.returncode == 0, command
    return usage.ru_utime + usage.ru_stime


def main() -> None:
    """Prints both."""
    mesh, pairs = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 3
    read = sm.read(mesh)
    v, f = read.vertices, read.faces
    start = time.process_time()
    surface = sm.Surface(v, f)
    made = surface.parametrize(threads=1)
    whole = time.process_time() - start
    native = made._made
    assert not isinstance(native, bytes)
    own = {
        "arrays in": seconds(lambda: (_arrays.floats(v, (-1, 3), "vertices").tobytes(), _arrays.polygons(f))),
        "surface out": seconds(lambda: surface._of(surface._native)),
        "map out": seconds(lambda: SeamlessMap._of(surface, native)),
    }
    print(f"{len(f)} triangles, {whole:.2f} s for surface and map")
    for name, cost in {**own, "in all": sum(own.values())}.items():
        print(f"{name:<12} {1e3 * cost:7.1f} ms  {100 * cost / whole:.2f} %")
    with tempfile.TemporaryDirectory() as folder:
        ours, theirs = Path(folder, "ours.obj"), Path(folder, "theirs.obj")
        command = [sys.executable, "-m", "seamstress_mesh", "map", mesh, "-o", str(theirs), "--quiet", "--threads", "1"]
        ratios = []
        for _ in range(pairs):
            package = of_process(sys.executable, "-c", THROUGH_PACKAGE, mesh, str(ours))
            alone = of_process(*command)
            ratios.append(package / alone)
            print(f"package {package:.2f} s, command {alone:.2f} s: {100 * (ratios[-1] - 1):+.2f} %", flush=True)
        same = "the same bytes" if ours.read_bytes() == theirs.read_bytes() else "other bytes"
        print(f"median {100 * (median(ratios) - 1):+.2f} %, {same}")


if __name__ == "__main__":
    main()
