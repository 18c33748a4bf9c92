# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests the extension in Blender as a module: ``python check.py [-k PATTERN]``.

Builds the wheel, makes environments with `bpy` from PyPI in `target/python`, and runs the tests there. Says so and ends
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

#: Blender with long-term support, the oldest that the extension is for, and the newest for the same Python.
BLENDERS = ["4.5", "4.2", "5.0"]
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


def blender(version: str) -> Path | None:
    """The interpreter of an environment with Blender as a module; none where there is none for this machine."""
    base = fitting()
    if base is None:
        print(f"SKIPPED: Blender {version} as a module needs Python {PYTHON}, which was not found")
        return None
    python = environment(f"blender-{version}", NEEDS, base)
    # Without its requirements, which let NumPy be too new for it.
    command = [python, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--no-deps", f"bpy=={version}.*"]
    if subprocess.run(command).returncode != 0:
        print(f"SKIPPED: PyPI has no bpy {version} for this machine")
        return None
    return python


def variables() -> dict[str, str]:
    """The wheel, built, as the tests and Python find it."""
    tools = environment("tools", TOOLS)
    wheels, site = FOLDER / "wheels", FOLDER / "blender-site"
    run(tools, ROOT / "crates" / "python" / "build.py", "--native", wheels)
    wheel = next(wheels.glob("*.whl"))
    # Beside the environments, since a Blender that has nothing is to install the package.
    shutil.rmtree(site, ignore_errors=True)
    run(tools, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--no-deps", "--target", site, wheel)
    return {**os.environ, "PYTHONPATH": str(site), "SEAMSTRESS_WHEEL": str(wheel)}


def main() -> None:
    found = {version: python for version in BLENDERS if (python := blender(version)) is not None}
    if not found:
        return
    given = variables()
    for version, python in found.items():
        print(f"== Blender {version}", flush=True)
        # Processes are the same in all of them.
        less = [] if version == BLENDERS[0] else ["--ignore=tests/test_jobs.py"]
        done = subprocess.run([python, "-m", "pytest", "-q", "tests", *less, *sys.argv[1:]], cwd=HERE, env=given)
        if done.returncode != 0:
            raise SystemExit(done.returncode)


if __name__ == "__main__":
    main()
