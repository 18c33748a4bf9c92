"""Builds the wheel and the source distribution: ``python build.py [--native] [FOLDER]``.

On Linux the wheel is one for manylinux2014, linked by zig, unless ``--native`` asks for one that suits this machine. It
needs maturin; for manylinux2014 also ziglang and auditwheel.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
MANYLINUX = "manylinux2014"


def build(folder: Path, native: bool) -> list[Path]:
    """The distributions, of which the wheel is the first."""
    shutil.rmtree(folder, ignore_errors=True)
    run = [sys.executable, "-m", "maturin"]
    command = [*run, "build", "--release", "--out", str(folder)]
    is_portable = sys.platform == "linux" and not native
    if is_portable:
        command += ["--zig", "--compatibility", MANYLINUX]
    elif sys.platform == "linux":
        command += ["--compatibility", "linux"]
    # Where its tools are, also if its environment is not activated.
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
    subprocess.run(command, check=True, cwd=HERE, env={**os.environ, "PATH": path})
    wheel = next(folder.glob("*.whl"))
    if native:
        return [wheel]
    if is_portable:
        shown = subprocess.run([sys.executable, "-m", "auditwheel", "show", str(wheel)], capture_output=True, text=True)
        print(shown.stdout)
        if "manylinux_2_17" not in shown.stdout:
            raise SystemExit(f"error: {wheel.name} is no wheel for {MANYLINUX}\n{shown.stderr}")
    subprocess.run([*run, "sdist", "--out", str(folder)], check=True, cwd=HERE)
    return [wheel, next(folder.glob("*.tar.gz"))]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--native", action="store_true", help="a wheel for this machine alone")
    parser.add_argument("folder", nargs="?", type=Path, default=HERE.parents[1] / "target" / "wheels")
    arguments = parser.parse_args()
    for path in build(arguments.folder.resolve(), arguments.native):
        print(f"{path}: {path.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
