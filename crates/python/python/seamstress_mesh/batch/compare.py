"""What became better or worse since another run."""

from __future__ import annotations

from pathlib import Path
from statistics import median
from typing import Any

from .manifest import NAME, Manifest

#: Figures that are compared, by the names of the report; less is better for each.
FIGURES = {
    "tau": "distortion.tau",
    "symmetric Dirichlet": "distortion.symmetric_dirichlet",
    "flipped": "distortion.flipped",
    "cones": "cones.count",
    "irregular": "quads.irregular.count",
    "dropped features": "features.dropped.count",
    "seconds": "cpu_seconds",
    "memory": "memory_bytes",
}
#: Differences below these parts are none: costs vary from run to run.
NOISE = {"seconds": 0.1, "memory": 0.1}
#: The least relative difference of the others.
LEAST = 1e-6
#: Meshes that are named.
NAMED = 5


def text(old: Path, new: Manifest, job: str) -> str:
    """A table of figures, each with the meshes that it became worse and better for, and all changes of status. In the same
    folder the run before is compared with.
    """
    path = old / NAME if old.is_dir() else old
    if not path.exists():
        return f"{old} has no {NAME} to compare with"
    manifest = Manifest(path, is_read=True)
    is_other = not path.samefile(new.path)
    jobs = [one["id"] for one in manifest.jobs() if is_other or one["id"] != job]
    before = {row["name"]: row for row in manifest.rows(jobs[-1])} if jobs else {}
    manifest.close()
    after = {row["name"]: row for row in new.rows(job) if row["name"] in before}
    lines = [f"{len(after)} meshes are in both"]
    for name, row in after.items():
        was, now = before[name]["status"], row["status"]
        if was != now:
            lines.append(f"  {name}: {was}, now {now}" + (f" ({row['code']})" if row["code"] else ""))
    lines.append(f"{'figure':<22}{'both':>6}{'better':>8}{'worse':>8}{'median new/old':>16}")
    for label, key in FIGURES.items():
        pairs = [(name, _value(before[name], key), _value(row, key)) for name, row in after.items()]
        known = [(name, a, b) for name, a, b in pairs if a is not None and b is not None]
        if known:
            lines += _lines(label, known)
    return "\n".join(lines)


def _lines(label: str, known: list[tuple[str, float, float]]) -> list[str]:
    least = NOISE.get(label, LEAST)
    changes = [(name, a, b) for name, a, b in known if abs(b - a) > least * max(abs(a), abs(b))]
    better = [one for one in changes if one[2] < one[1]]
    worse = [one for one in changes if one[2] > one[1]]
    ratios = [b / a for _, a, b in known if a > 0.0]
    ratio = f"{median(ratios):.4f}" if ratios else "-"
    lines = [f"{label:<22}{len(known):>6}{len(better):>8}{len(worse):>8}{ratio:>16}"]
    worst = sorted(worse, key=lambda one: one[1] / one[2] if one[2] else 0.0)[:NAMED]
    lines += [f"  worse: {name} {a:.6g} -> {b:.6g}" for name, a, b in worst]
    return lines


def _value(row: dict[str, Any], key: str) -> float | None:
    value = row["metrics"].get(key, row.get(key))
    if value in ("inf", "-inf", "nan"):
        return float(value)
    return float(value) if isinstance(value, (int, float)) else None
