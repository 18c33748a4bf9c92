"""Builds the wheel, installs it into environments of their own, and runs the tests there: ``python check.py``.

One environment has NumPy 2 and all that the examples use; one has NumPy 1.26; one has NumPy alone, as after
``pip install seamstress-mesh``. They are made in ``target/python`` and kept for the next time.
"""

from __future__ import annotations

import os
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
FOLDER = ROOT / "target" / "python"
TOOLS = ["maturin>=1.9,<2"]
TESTS = ["pytest", "hypothesis"]
#: What the tests of types, examples and batches use beside.
ALL = [*TESTS, "mypy", "tqdm", "trimesh", "meshio", "pandas", "pyarrow", "libigl", "scipy", "nbclient", "nbformat", "ipykernel", "pillow"]
if sys.platform == "linux":
    ALL += ["ray"]
#: The one-line check of a clean environment.
TRY = "import seamstress_mesh as sm; print(sm.read('samples/bracket.obj').parametrize())"


def environment(name: str, packages: list[str]) -> Path:
    """The interpreter of an environment with these packages."""
    folder = FOLDER / name
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if not python.exists():
        venv.create(folder, with_pip=True)
    if packages:
        run(python, "-m", "pip", "install", "-q", "--disable-pip-version-check", *packages)
    return python


def run(*command: object, folder: Path = ROOT) -> None:
    """Runs a command, and ends if it fails."""
    print("+", *command, flush=True)
    done = subprocess.run([str(part) for part in command], cwd=folder)
    if done.returncode != 0:
        raise SystemExit(done.returncode)


def main() -> None:
    wheels = FOLDER / "wheels"
    run(environment("tools", TOOLS), HERE / "build.py", "--native", wheels)
    wheel = next(wheels.glob("*.whl"))
    again = ["--force-reinstall", "--no-deps", str(wheel)]
    for name, numpy, packages in (("all", "numpy>=2", ALL), ("numpy1", "numpy==1.26.*", TESTS), ("clean", "numpy", [])):
        python = environment(name, [numpy, *packages])
        run(python, "-m", "pip", "install", "-q", "--disable-pip-version-check", *again)
        if packages:
            chosen = [] if name == "all" else [f"tests/test_{part}.py" for part in ("arrays", "errors", "maps")]
            run(python, "-m", "pytest", "-q", *chosen, folder=HERE)
        else:
            run(python, "-c", TRY)


if __name__ == "__main__":
    sys.exit(main())
