"""The manifest as a table of one column a number, and in a few lines."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from statistics import median
from typing import Any

from .driver import duration
from .manifest import COLUMNS, Manifest

#: Rows that are written at once.
CHUNK = 10_000
#: Figures of the summary, by the names of the report.
FIGURES = {
    "tau": "distortion.tau",
    "cones": "cones.count",
    "quads": "quads.count",
    "irregular": "quads.irregular.count",
}


def _chunks(rows: Iterator[dict[str, Any]]) -> Iterator[list[dict[str, Any]]]:
    while chunk := list(islice(rows, CHUNK)):
        yield chunk


def _flat(row: dict[str, Any]) -> dict[str, Any]:
    return {**{name: row[name] for name in COLUMNS if name != "metrics"}, **row["metrics"]}


def _columns(manifest: Manifest, job: str) -> dict[str, str]:
    """The columns of the table, each a number, a truth value or a text; what is of several kinds is a text."""
    kinds: dict[str, set[str]] = {}
    for row in manifest.rows(job):
        for name, value in _flat(row).items():
            if value is not None:
                kinds.setdefault(name, set()).add(type(value).__name__)
    found: dict[str, str] = {}
    for name in [*(name for name in COLUMNS if name != "metrics"), *sorted(set(kinds) - set(COLUMNS))]:
        kind = kinds.get(name, {"str"})
        # Numbers that JSON does not have are texts.
        found[name] = kind.pop() if len(kind) == 1 else "float" if kind <= {"int", "float", "str"} and "str" not in kind else "str"
    return found


def write(manifest: Manifest, job: str, folder: Path) -> Path:
    """Writes the table as ``results.parquet``, or without pyarrow as ``results.csv``; it appears when it is complete."""
    columns = _columns(manifest, job)
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError:
        return _write_csv(manifest, job, folder / "results.csv", list(columns))
    types = {"int": pyarrow.int64(), "float": pyarrow.float64(), "bool": pyarrow.bool_(), "str": pyarrow.string()}
    schema = pyarrow.schema([(name, types.get(kind, types["str"])) for name, kind in columns.items()])
    path, temporary = folder / "results.parquet", folder / ".results.parquet"
    with pyarrow.parquet.ParquetWriter(temporary, schema) as writer:
        for rows in _chunks(manifest.rows(job)):
            flat = [_flat(row) for row in rows]
            arrays = [
                pyarrow.array([_as(kind, row.get(name)) for row in flat], schema.field(name).type)
                for name, kind in columns.items()
            ]
            writer.write_table(pyarrow.table(arrays, schema=schema))
    os.replace(temporary, path)
    return path


def _as(kind: str, value: Any) -> Any:
    if value is None:
        return None
    return {"float": float, "str": str}.get(kind, lambda same: same)(value)


def _write_csv(manifest: Manifest, job: str, path: Path, columns: list[str]) -> Path:
    temporary = path.with_name(f".{path.name}")
    with temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns)
        writer.writeheader()
        for row in manifest.rows(job):
            writer.writerow(_flat(row))
    os.replace(temporary, path)
    return path


def summary(manifest: Manifest, job: str, names: set[str]) -> str:
    """How many ended how, what that cost, and medians."""
    counts: dict[str, int] = {}
    codes: dict[str, int] = {}
    figures: dict[str, list[float]] = {name: [] for name in FIGURES}
    seconds, cpu, memory, slowest = 0.0, 0.0, 0, (0.0, "")
    for row in manifest.rows(job):
        if row["name"] not in names:
            continue
        counts[row["status"]] = counts.get(row["status"], 0) + 1
        if row["status"] != "ok":
            code = row["code"] or "unknown"
            codes[code] = codes.get(code, 0) + 1
        for name, key in FIGURES.items():
            value = row["metrics"].get(key)
            if isinstance(value, (int, float)):
                figures[name].append(value)
        seconds += row["seconds"] or 0.0
        cpu += row["cpu_seconds"] or 0.0
        memory = max(memory, row["memory_bytes"] or 0)
        slowest = max(slowest, (row["seconds"] or 0.0, row["name"]))
    lines = [f"{'meshes':<13}{', '.join(f'{n} {status}' for status, n in sorted(counts.items()))}"]
    if codes:
        worst = sorted(codes.items(), key=lambda one: (-one[1], one[0]))
        lines.append(f"{'not ok':<13}{', '.join(f'{n} {code}' for code, n in worst)}")
    for name, values in figures.items():
        if values:
            lines.append(f"{name:<13}median {median(values):.4g}, largest {max(values):.4g}")
    lines.append(
        f"{'cost':<13}{duration(cpu)} of computation, {duration(seconds)} in all tasks; slowest {slowest[1]} with"
        f" {duration(slowest[0])}; most memory {memory / 1e9:.2f} GB"
    )
    return "\n".join(lines)
