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


def find(inputs: Iterable[str]) -> dict[str, str]:
    """The meshes by their names: the paths below the folder given, without their endings."""
    meshes: dict[str, str] = {}
    for given in inputs:
        for name, path in _of(given):
            path = os.path.abspath(path)
            if meshes.setdefault(name, path) != path:
                # Two of one name: the path tells them apart.
                name = f"{name}-{hashlib.sha256(path.encode()).hexdigest()[:8]}"
                meshes[name] = path
    return meshes


def _of(given: str) -> Iterator[tuple[str, str]]:
    if os.path.isdir(given):
        for folder, folders, files in os.walk(given, followlinks=True):
            folders.sort()
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
        with path.open(newline="") as file:
            rows = _column(list(csv.DictReader(file, delimiter="," if path.suffix == ".csv" else "\t")), given)
    elif path.suffix in ("", ".txt", ".list"):
        lines = (line.strip() for line in path.read_text().splitlines())
        rows = [line for line in lines if line and not line.startswith("#")]
    else:
        raise InputsError(f"{given}: neither a mesh nor a list of meshes (.txt, .csv, .tsv or .parquet)")
    for row in rows:
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
