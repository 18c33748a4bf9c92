# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests the extension in Blender as a module: ``python check.py [-k PATTERN]``.

Builds the wheel, makes an environment with `bpy` from PyPI in `target/python`, and runs the tests there. Says so and ends
well where no `bpy` fits: it is for one version of Python, and for few systems.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path.insert(0, str(ROOT / "crates" / "python"))

from check import FOLDER, TOOLS, environment, run  # noqa: E402

#: Blender with long-term support, the Python that it is for, and what it needs.
BLENDER = "4.5"
PYTHON = "3.11"
NEEDS = ["numpy<2", "cython", "requests", "zstandard", "pytest", "pillow"]


def fitting() -> Path | None:
    """The interpreter that Blender is for: this one, on the path, or where pyenv keeps it."""
    name = f"python{PYTHON}"
    found = [sys.executable, shutil.which(name), *Path.home().glob(f".pyenv/versions/{PYTHON}.*/bin/{name}")]
    for python in filter(None, found):
        told = subprocess.run([python, "-V"], capture_output=True, text=True)
        if told.returncode == 0 and told.stdout.startswith(f"Python {PYTHON}."):
            return Path(python)
    return None


def blender() -> Path | None:
    """The interpreter of an environment with Blender as a module; none where there is none for this machine."""
    base = fitting()
    if base is None:
        print(f"SKIPPED: Blender {BLENDER} as a module needs Python {PYTHON}, which was not found")
        return None
    python = environment("blender", NEEDS, base)
    # Without its requirements, which let NumPy be too new for it.
    command = [python, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--no-deps", f"bpy=={BLENDER}.*"]
    if subprocess.run(command).returncode != 0:
        print(f"SKIPPED: PyPI has no bpy {BLENDER} for this machine")
        return None
    return python


def prepared() -> tuple[Path, Path, dict[str, str]] | None:
    """The interpreter with Blender, the wheel, and the variables with which Python finds what is in it."""
    python = blender()
    if python is None:
        return None
    wheels, site = FOLDER / "wheels", FOLDER / "blender-site"
    run(environment("tools", TOOLS), ROOT / "crates" / "python" / "build.py", "--native", wheels)
    wheel = next(wheels.glob("*.whl"))
    # Beside the environment, since a Blender that has nothing is to install the package.
    shutil.rmtree(site, ignore_errors=True)
    run(python, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--no-deps", "--target", site, wheel)
    return python, wheel, {**os.environ, "PYTHONPATH": str(site), "SEAMSTRESS_WHEEL": str(wheel)}


def main() -> int:
    made = prepared()
    if made is None:
        return 0
    python, _, variables = made
    return subprocess.run([python, "-m", "pytest", "-q", "tests", *sys.argv[1:]], cwd=HERE, env=variables).returncode


if __name__ == "__main__":
    sys.exit(main())
