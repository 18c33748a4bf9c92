"""How soon calls stop: ``python crates/python/tests/stops.py MESH [STOPS]``.

Each call is stopped after random times in each way, and the time until Python goes on is measured, and that until the
threads of the work are gone. Linux.
"""

from __future__ import annotations

import os
import random
import signal
import sys
import threading
import time
from typing import Any

import seamstress_mesh as sm

CALLS: dict[str, dict[str, Any]] = {"parametrize": {}, "integer_map": {"quads": 5000}, "quad_mesh": {"quads": 5000}}


def n_threads() -> int:
    """The threads of this process."""
    return len(os.listdir("/proc/self/task"))


def by_timeout(call: Any, seconds: float, options: dict[str, Any]) -> None:
    try:
        call(timeout=seconds, **options)
    except sm.Stopped as stopped:
        assert stopped.code == "time-limit", stopped


def by_callback(call: Any, seconds: float, options: dict[str, Any]) -> None:
    start = time.monotonic()
    try:
        call(progress=lambda stage, fraction: time.monotonic() - start < seconds, **options)
    except sm.Stopped as stopped:
        assert stopped.code == "cancelled", stopped


def by_ctrl_c(call: Any, seconds: float, options: dict[str, Any]) -> None:
    timer = threading.Timer(seconds, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    try:
        call(**options)
    except KeyboardInterrupt:
        timer.join()
    finally:
        timer.cancel()


def main() -> None:
    """Prints the longest times."""
    surface = sm.read(sys.argv[1])
    stops = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    chance = random.Random(1)
    print(f"{len(surface.faces)} triangles, {os.cpu_count()} cores; seconds until Python goes on, and until the work has ended")
    worst = [0.0, 0.0]
    for name, options in CALLS.items():
        call = getattr(surface, name)
        start = time.monotonic()
        call(**options)
        whole = time.monotonic() - start
        print(f"{name}, {whole:.1f} s")
        for way in (by_timeout, by_callback, by_ctrl_c):
            shown = []
            for _ in range(stops):
                seconds = chance.uniform(0.0, 0.9 * whole)
                idle, start = n_threads(), time.monotonic()
                way(call, seconds, options)
                back = time.monotonic() - start - seconds
                while n_threads() > idle:
                    time.sleep(0.005)
                ended = time.monotonic() - start - seconds
                worst = [max(worst[0], back), max(worst[1], ended)]
                # It may have made its result before.
                shown.append(f"{seconds:.1f} s: {back:.2f}, {ended:.2f}" if back >= 0.0 else "too late")
            print(f"  {way.__name__.replace('_', ' '):<12} {'; '.join(shown)}", flush=True)
    print(f"longest {worst[0]:.2f}, {worst[1]:.2f}")


if __name__ == "__main__":
    main()
