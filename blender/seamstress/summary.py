# SPDX-License-Identifier: GPL-3.0-or-later
"""What is told of results, and kept with the meshes for the panel."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

import bpy
from bpy.app.translations import pgettext_rpt as rpt

#: The custom property of meshes.
PROPERTY = "seamstress"


@dataclass(frozen=True)
class Summary:
    """What a mesh is, or its map, in figures for people."""

    title: str
    figures: dict[str, str]

    @classmethod
    def of_quads(cls, mesh: bpy.types.Mesh, report: dict[str, Any]) -> Summary:
        """Of a quad mesh. Mirrored sides count."""
        sides = len(mesh.polygons) / max(report["quads"]["count"], 1)
        features = report.get("features") or {"edges": 0, "kept": 0}
        figures = {
            rpt("Quads"): f"{len(mesh.polygons):,}",
            rpt("Irregular vertices"): f"{round(report['quads']['irregular']['count'] * sides):,}",
            rpt("Manifold"): rpt("yes") if report["quads"]["is_manifold"] else rpt("no"),
            rpt("Edges followed"): f"{features['kept']:,} {rpt('of')} {features['edges']:,}",
            rpt("Inverted quads"): f"{report['orientation']['inverted']:,}",
        }
        return cls(rpt("Quad mesh"), figures)

    @classmethod
    def of_map(cls, report: dict[str, Any], title: str | None = None) -> Summary:
        """Of a seamless map."""
        certificate, distortion = report["certificate"], report["distortion"]
        figures = {
            rpt("Flipped triangles"): f"{distortion['flipped']:,}",
            rpt("Cones"): f"{certificate['cones']:,}",
            rpt("Seam edges"): f"{certificate['seam_edges']:,}",
            rpt("Seams fit to"): f"{certificate['seam_residual']:.1e} {rpt('edge lengths')}",
            rpt("Angles fit to"): f"{certificate['angle_error']:.1e} rad",
            rpt("Largest distortion"): f"{distortion['tau']:.3f}",
        }
        return cls(title or rpt("Certified seamless map"), figures)

    def text(self) -> str:
        """In one line: the first two figures."""
        return ", ".join(f"{name}: {value}" for name, value in list(self.figures.items())[:2])

    def store(self, mesh: bpy.types.Mesh) -> None:
        """Keeps it with a mesh."""
        counts = [len(mesh.vertices), len(mesh.polygons)]
        mesh[PROPERTY] = {
            "title": self.title,
            "counts": counts,
            **{f"figure {name}": text for name, text in self.figures.items()},
        }

    @classmethod
    def stored(cls, mesh: bpy.types.Mesh) -> Summary | None:
        """What is kept with a mesh, unless the mesh has changed."""
        kept = mesh.get(PROPERTY)
        if kept is None or list(kept["counts"]) != [len(mesh.vertices), len(mesh.polygons)]:
            return None
        figures = {name.removeprefix("figure "): kept[name] for name in kept.keys() if name.startswith("figure ")}
        return cls(kept["title"], figures)


def dropped_edges(report: dict[str, Any]) -> list[list[int]]:
    """The edges that could not be followed, by their ends."""
    return [edge["vertices"] for edge in (report.get("features") or {}).get("dropped") or []]


def dropped_text(report: dict[str, Any]) -> str:
    """How many edges could not be followed, and why; empty if there are none."""
    reasons = Counter(edge["reason"].replace("-", " ") for edge in (report.get("features") or {}).get("dropped") or [])
    if not reasons:
        return ""
    named = ", ".join(f"{count} {reason}" for reason, count in reasons.most_common())
    return rpt("edges not followed: {}").format(named)


def repairs_text(report: dict[str, Any]) -> str:
    """What was repaired; empty if nothing was."""
    repairs = report["input"].get("repairs") or []
    return rpt("{} repairs").format(len(repairs)) if repairs else ""
