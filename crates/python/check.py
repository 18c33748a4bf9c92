"""Builds the wheel, installs it into environments of their own, and runs the tests there: ``python check.py``.

One environment has NumPy 2 and all that the examples use; one has NumPy 1.26; one has the oldest Python, if
``python3.9`` is found; one has NumPy alone, as after ``pip install seamstress-mesh``. They are made in ``target/python``
and kept for the next time.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
FOLDER = ROOT / "target" / "python"
TOOLS = ["maturin>=1.9,<2"]
TESTS = ["pytest", "hypothesis"]
#: What the tests of types, examples and batches use beside.
ALL = [*TESTS, "mypy", "tqdm", "trimesh", "meshio", "pandas", "pyarrow", "libigl", "scipy", "pyvista", "nbclient", "nbformat", "ipykernel", "pillow"]
if sys.platform == "linux":
    ALL += ["ray"]
#: The one-line check of a clean environment.
TRY = "import seamstress_mesh as sm; print(sm.read('samples/bracket.obj').parametrize())"


#: The oldest Python that the wheel is for.
OLDEST = "python3.9"
#: The tests that need no other packages.
PARTS = ["arrays", "errors", "maps", "running", "batch"]


def oldest() -> Path | None:
    """The interpreter of the oldest Python, if there is one: on the path, or where pyenv keeps it."""
    found = [shutil.which(OLDEST), *Path.home().glob(f".pyenv/versions/*/bin/{OLDEST}")]
    for python in filter(None, found):
        # Shims of pyenv are there for versions that are not chosen, too.
        if subprocess.run([python, "-V"], capture_output=True).returncode == 0:
            return Path(python)
    return None


def environment(name: str, packages: list[str], base: Path = Path(sys.executable)) -> Path:
    """The interpreter of an environment with these packages, made by another interpreter."""
    folder = FOLDER / name
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if not python.exists():
        run(base, "-m", "venv", folder)
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
    parts = [f"tests/test_{part}.py" for part in PARTS]
    environments = {
        "all": environment("all", ["numpy>=2", *ALL]),
        "numpy1": environment("numpy1", ["numpy==1.26.*", *TESTS]),
        "clean": environment("clean", ["numpy"]),
    }
    if base := oldest():
        environments["oldest"] = environment("oldest", ["numpy", *TESTS], base)
    else:
        print(f"{OLDEST} was not found: no tests with it")
    for name, python in environments.items():
        run(python, "-m", "pip", "install", "-q", "--disable-pip-version-check", *again)
        if name == "clean":
            run(python, "-c", TRY)
        else:
            run(python, "-m", "pytest", "-q", *(parts if name != "all" else []), folder=HERE)


if __name__ == "__main__":
    sys.exit(main())
