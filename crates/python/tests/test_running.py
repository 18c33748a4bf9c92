"""Work beside Python: threads, forks, signals, progress, limits."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Optional

import pytest
from shapes import sphere

import seamstress_mesh as sm

#: A mesh that takes a second or two.
LARGE = sm.Surface(*sphere(100, 150))
#: One that takes long enough to be stopped.
LARGER = sm.Surface(*sphere(150, 225))


@pytest.fixture
def ends() -> Iterator[None]:
    """The threads of work that was stopped have to end soon, too."""
    if sys.platform != "linux":
        yield
        return
    threads = set(os.listdir("/proc/self/task"))
    yield
    deadline = time.monotonic() + 5.0
    while left := set(os.listdir("/proc/self/task")) - threads:
        assert time.monotonic() < deadline, left
        time.sleep(0.01)


def test_the_lock_is_free_meanwhile(spot: sm.Surface) -> None:
    ticks, done = 0, threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not done.wait(0.005):
            ticks += 1

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.monotonic()
    spot.parametrize()
    elapsed = time.monotonic() - start
    done.set()
    thread.join()
    assert ticks > 0.1 * elapsed / 0.005


def test_many_threads_at_once(spot: sm.Surface, spot_map: sm.SeamlessMap) -> None:
    with ThreadPoolExecutor(4) as pool:
        maps = list(pool.map(lambda _: spot.parametrize(threads=1, no_tau_polish=True), range(4)))
    assert len({m.uv.tobytes() for m in maps}) == 1


def _child(queue: Any, surface: sm.Surface) -> None:
    queue.put(surface.parametrize(no_tau_polish=True).uv.tobytes())


@pytest.mark.skipif(sys.platform == "win32", reason="no fork")
def test_forks_after_use(spot: sm.Surface) -> None:
    here = spot.parametrize(no_tau_polish=True)
    spot.measure(here.uv, here.face_uv)
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=_child, args=(queue, spot))
    child.start()
    try:
        assert queue.get(timeout=120) == here.uv.tobytes()
    finally:
        child.kill()
        child.join()


def test_processes_get_results_back(spot: sm.Surface, spot_map: sm.SeamlessMap) -> None:
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        made = pool.apply(sm.Surface.parametrize, (spot,))
    assert made.uv.tobytes() == spot_map.uv.tobytes()


def test_progress_is_told(spot: sm.Surface) -> None:
    told: list[tuple[str, float]] = []
    main = threading.get_ident()

    def tell(stage: str, fraction: float) -> Optional[bool]:
        assert threading.get_ident() == main
        told.append((stage, fraction))
        return None

    spot.parametrize(progress=tell)
    stages = list(dict.fromkeys(stage for stage, _ in told))
    assert "rounding" in stages and all(0.0 <= fraction <= 1.0 for _, fraction in told)


def test_a_bar_is_shown(spot: sm.Surface, capsys: pytest.CaptureFixture[str]) -> None:
    spot.parametrize(progress=True)
    assert "%" in capsys.readouterr().err


def test_the_function_is_asked_all_the_time() -> None:
    # Also from the start, before there is any news.
    asked = [time.monotonic()]
    calls: list[tuple[str, float]] = []

    def tell(stage: str, fraction: float) -> None:
        asked.append(time.monotonic())
        calls.append((stage, fraction))

    LARGE.quad_mesh(3000, progress=tell)
    asked.append(time.monotonic())
    assert max(b - a for a, b in zip(asked, asked[1:])) < 1.0
    assert all(0.0 <= fraction <= 1.0 for _, fraction in calls)


@pytest.mark.parametrize("call", ["parametrize", "integer_map", "quad_mesh"])
def test_false_stops(call: str, ends: None) -> None:
    start = time.monotonic()
    size = {} if call == "parametrize" else {"quads": 1000}
    with pytest.raises(sm.Stopped) as raised:
        getattr(LARGE, call)(progress=lambda stage, fraction: False, **size)
    assert raised.value.code == "cancelled"
    assert time.monotonic() - start < 1.0


def test_what_the_function_raises_comes_out(ends: None) -> None:
    def tell(stage: str, fraction: float) -> bool:
        raise KeyError(stage)

    with pytest.raises(KeyError):
        LARGE.parametrize(progress=tell)


@pytest.mark.parametrize("seconds", [0.05, 0.5, 1.5])
def test_the_time_limit(seconds: float, ends: None) -> None:
    start = time.monotonic()
    with pytest.raises(sm.Stopped) as raised:
        LARGER.quad_mesh(3000, timeout=seconds)
    assert raised.value.code == "time-limit"
    assert seconds <= time.monotonic() - start < seconds + 1.0


def test_the_memory_limit() -> None:
    with pytest.raises(sm.Stopped, match="memory") as raised:
        LARGE.quad_mesh(3000, memory_limit=10_000_000)
    assert raised.value.code == "memory-limit"
    with pytest.raises(sm.InputError):
        LARGE.parametrize(memory_limit=0)


@pytest.mark.skipif(sys.platform == "win32", reason="no kill")
@pytest.mark.parametrize("seconds", [0.1, 1.0])
def test_ctrl_c_stops(seconds: float, ends: None) -> None:
    # Where tests run in the background, the signal is ignored at first.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(seconds, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        LARGER.quad_mesh(3000)
    assert time.monotonic() - start < seconds + 1.0
