"""The command in a process of its own, under limits, without the package around it: it starts in a tenth of the time.

    python -I -S _command.py LIMITS map spot.obj -o spot_map.obj

LIMITS is JSON: ``cpu`` in seconds, ``memory`` in bytes, and ``parent``, the process with whose end this one ends.
"""

import importlib.machinery
import importlib.util
import json
import os
import signal
import sys
from typing import Any


def limit(cpu: "float | None" = None, memory: "float | None" = None, parent: "int | None" = None) -> None:
    """Limits this process, as far as the system can."""
    try:
        import resource
    except ImportError:
        return
    if cpu is not None:
        # The hard limit kills what ignores the soft one.
        resource.setrlimit(resource.RLIMIT_CPU, (max(1, round(cpu)), max(1, round(cpu)) + 5))
    if memory is not None:
        # On Linux what is written to, wherever it is; elsewhere the address space, of which threads reserve much.
        kind = resource.RLIMIT_DATA if sys.platform == "linux" else resource.RLIMIT_AS
        resource.setrlimit(kind, (round(memory), round(memory)))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if parent is not None and sys.platform == "linux":
        import ctypes

        die_with_parent = 1
        ctypes.CDLL(None).prctl(die_with_parent, signal.SIGKILL)
        if os.getppid() != parent:
            # It ended before it could be watched.
            sys.exit(1)


def native() -> Any:
    """The compiled half of the package that this file is of."""
    folder = os.path.dirname(os.path.abspath(__file__))
    for suffix in importlib.machinery.EXTENSION_SUFFIXES:
        path = os.path.join(folder, "_native" + suffix)
        if os.path.exists(path):
            spec = importlib.util.spec_from_file_location("seamstress_mesh._native", path)
            assert spec is not None and spec.loader is not None
            module = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
            return module
    raise ImportError("the compiled half of seamstress_mesh is missing")


if __name__ == "__main__":
    limit(**json.loads(sys.argv[1]))
    sys.exit(native().main(["seamstress", *sys.argv[2:]]))
