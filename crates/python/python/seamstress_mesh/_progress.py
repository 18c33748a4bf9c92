"""Who is told of progress."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Callable, Optional

from ._errors import InputError

Told = Optional[Callable[[str, float], Optional[bool]]]
#: Threads, seconds, bytes, and who is told of progress.
Run = "tuple[int | None, float | None, int | None, Told]"


@contextmanager
def running(options: Mapping[str, Any]) -> Iterator[tuple[int | None, float | None, int | None, Told]]:
    """How a call is run, with a bar if ``progress`` is ``True``."""
    names = ("threads", "timeout", "memory_limit", "progress")
    threads, timeout, memory, progress = (options.get(name) for name in names)
    if threads is not None and (threads != int(threads) or not 1 <= threads <= 1024):
        raise InputError(f"threads: {threads} is no whole number from 1 to 1024")
    if timeout is not None and not timeout > 0:
        raise InputError(f"timeout: {timeout} is no number of seconds larger than 0")
    if memory is not None and not 1 <= memory < 2**64:
        raise InputError(f"memory_limit: {memory} is no number of bytes larger than 0")
    timeout = None if timeout is None else float(timeout)
    memory = None if memory is None else int(memory)
    threads = None if threads is None else int(threads)
    if progress is True:
        with _bar() as told:
            yield threads, timeout, memory, told
    else:
        yield threads, timeout, memory, progress or None


@contextmanager
def _bar() -> Iterator[Told]:
    """A bar of tqdm if that is installed, else a line on standard error."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        yield _line
        print(file=sys.stderr)
        return
    with tqdm(total=100, bar_format="{desc:<14}{percentage:3.0f}%|{bar}| {elapsed}") as bar:

        def told(stage: str, fraction: float) -> None:
            bar.set_description_str(stage, refresh=False)
            bar.n = round(100 * fraction)
            bar.refresh()

        yield told


def _line(stage: str, fraction: float) -> None:
    print(f"\r{stage:<14} {100 * fraction:3.0f} %", end="", file=sys.stderr, flush=True)
