"""Inputs: folders, files, globs, lists, and tables of meshes."""

from __future__ import annotations

import csv
import glob
import hashlib
import os
from collections.abc import Iterable, Iterator
from pathlib import Path

#: Endings of meshes; each also with ``.gz``.
MESHES = (".obj", ".off", ".ply", ".stl")
#: Columns of tables that may name the mesh.
COLUMNS = ("mesh", "path", "file", "filename")


class InputsError(Exception):
    """What is given as inputs is none."""


def is_mesh(path: str) -> bool:
    """Whether a name is that of a mesh."""
    name = path.lower()
    return name.removesuffix(".gz").endswith(MESHES)


def find(inputs: Iterable[str], output: Path) -> dict[str, str]:
    """The meshes by their names, which are the paths below the folder given. Results of other runs are none."""
    meshes: dict[str, str] = {}
    results = os.path.realpath(output) + os.sep
    for given in inputs:
        for name, path in _of(given):
            if os.path.realpath(path).startswith(results):
                continue
            name, path = printable(name), os.path.abspath(path)
            if meshes.setdefault(name, path) != path:
                # Two of one name: the path tells them apart.
                name = f"{name}-{hashlib.sha256(path.encode()).hexdigest()[:8]}"
                meshes[name] = path
    return meshes


def printable(name: str) -> str:
    """A name in characters: what is no UTF-8 in the name of a file is written as its bytes."""
    return os.fsencode(name).decode(errors="backslashreplace")


def _is_loop(folder: str) -> bool:
    """Whether a folder is a link to one that it is in."""
    around = os.path.realpath(os.path.dirname(folder)) + os.sep
    return os.path.islink(folder) and around.startswith(os.path.realpath(folder) + os.sep)


def _of(given: str) -> Iterator[tuple[str, str]]:
    if os.path.isdir(given):
        for folder, folders, files in os.walk(given, followlinks=True):
            folders[:] = sorted(name for name in folders if not _is_loop(os.path.join(folder, name)))
            for file in sorted(files):
                if is_mesh(file):
                    path = os.path.join(folder, file)
                    yield os.path.relpath(path, given).replace(os.sep, "/"), path
    elif is_mesh(given) and os.path.exists(given):
        yield os.path.basename(given), given
    elif glob.has_magic(given):
        for path in sorted(glob.glob(given, recursive=True)):
            if is_mesh(path):
                yield os.path.basename(path), path
    else:
        yield from _listed(given)


def _listed(given: str) -> Iterator[tuple[str, str]]:
    """The meshes of a list, one a line, or of a column of a table; paths are those from its folder."""
    path = Path(given)
    if not path.exists():
        raise InputsError(f"{given}: no such file, folder or pattern")
    if path.suffix == ".parquet":
        rows = _parquet(path)
    elif path.suffix in (".csv", ".tsv"):
        with path.open(newline="", encoding="utf-8-sig") as file:
            rows = _column(list(csv.DictReader(file, delimiter="," if path.suffix == ".csv" else "\t")), given)
    elif path.suffix in ("", ".txt", ".list"):
        lines = (line.strip() for line in path.read_text(encoding="utf-8-sig").splitlines())
        rows = [line for line in lines if line and not line.startswith("#")]
    else:
        raise InputsError(f"{given}: neither a mesh nor a list of meshes (.txt, .csv, .tsv or .parquet)")
    for number, row in enumerate(rows, 1):
        if not isinstance(row, str) or not row:
            raise InputsError(f"{given}: row {number} has no path of a mesh but {row!r}")
        name = row if not os.path.isabs(row) else os.path.basename(row)
        parts = [part for part in name.replace(os.sep, "/").split("/") if part not in ("..", ".", "")]
        yield "/".join(parts), str(path.parent / row)


def _parquet(path: Path) -> list[str]:
    try:
        import pyarrow.parquet
    except ImportError:
        raise InputsError(f"{path}: tables in Parquet need pyarrow: pip install seamstress-mesh[parquet]") from None
    names = pyarrow.parquet.read_schema(path).names
    column = next((name for name in COLUMNS if name in names), None)
    if column is None:
        raise InputsError(f"{path}: no column is called {', '.join(COLUMNS)}")
    values: list[str] = pyarrow.parquet.read_table(path, columns=[column])[column].to_pylist()
    return values


def _column(rows: list[dict[str, str]], given: str) -> list[str]:
    column = next((name for name in COLUMNS if rows and name in rows[0]), None)
    if rows and column is None:
        raise InputsError(f"{given}: no column is called {', '.join(COLUMNS)}")
    return [row[column] for row in rows] if column else []
