"""The ``seamstress`` command: ``python -m seamstress_mesh map spot.obj -o spot_map.obj``."""

import sys

from ._native import main as run


def main() -> int:
    """Runs the command with the arguments of this process; returns its exit code."""
    return run(["seamstress", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
