# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the extension with wheels of `seamstress-mesh`, one for each platform: ``python build.py WHEEL... [-o FOLDER]``."""

from __future__ import annotations

import argparse
import re
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE / "seamstress"
#: Platforms of Blender, and the tags of the wheels that run there.
PLATFORMS = {
    "linux-x64": r"(many|musl)?linux.*_x86_64",
    "linux-arm64": r"(many|musl)?linux.*_aarch64",
    "macos-arm64": r"macosx_.*_(arm64|universal2)",
    "macos-x64": r"macosx_.*_(x86_64|universal2)",
    "windows-arm64": r"win_arm64",
    "windows-x64": r"win_amd64",
}
#: When files of the package are dated, so that the same sources give the same bytes.
DATE = (1980, 1, 1, 0, 0, 0)


def platforms(wheels: list[Path]) -> list[str]:
    """The platforms that wheels are for."""
    tags = [wheel.stem.rsplit("-", 1)[1] for wheel in wheels]
    found = [name for name, pattern in PLATFORMS.items() if any(re.fullmatch(pattern, tag) for tag in tags)]
    if not found:
        raise SystemExit(f"error: no platform of Blender runs {', '.join(tags)}")
    return found


def version(text: str) -> str:
    """The version that a manifest says."""
    return re.search(r'^version = "(.*)"$', text, re.MULTILINE)[1]


def manifest(wheels: list[Path]) -> str:
    """The manifest of the package with these wheels."""
    text = (SOURCE / "blender_manifest.toml").read_text()
    for wheel in wheels:
        if wheel.name.split("-")[1] != version(text):
            raise SystemExit(f"error: {wheel.name} is not of version {version(text)}")
    # Without the remark on what is added here; before the first table.
    head, table, rest = text.partition("\n[")
    lines = [line for line in head.splitlines() if not line.startswith("#")]
    names = "".join(f'  "./wheels/{wheel.name}",\n' for wheel in wheels)
    listed = ", ".join(f'"{name}"' for name in platforms(wheels))
    return "\n".join([*lines, f"platforms = [{listed}]", f"wheels = [\n{names}]", ""]) + table + rest


def build(wheels: list[Path], folder: Path) -> Path:
    """The package, a zip file."""
    text = manifest(wheels)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"seamstress-{version(text)}.zip"
    sources = [file for file in sorted(SOURCE.rglob("*")) if file.is_file() and "__pycache__" not in file.parts]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as package:

        def add(name: str, content: bytes) -> None:
            package.writestr(zipfile.ZipInfo(name, DATE), content, zipfile.ZIP_DEFLATED)

        add("blender_manifest.toml", text.encode())
        for file in sources:
            if file.name != "blender_manifest.toml":
                add(file.relative_to(SOURCE).as_posix(), file.read_bytes())
        for wheel in wheels:
            add(f"wheels/{wheel.name}", wheel.read_bytes())
    return path


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("wheels", nargs="+", type=Path, metavar="WHEEL")
    parser.add_argument("-o", dest="folder", type=Path, default=HERE.parent / "target" / "blender")
    arguments = parser.parse_args()
    path = build(arguments.wheels, arguments.folder)
    print(f"{path}: {path.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
