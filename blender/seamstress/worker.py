# SPDX-License-Identifier: GPL-3.0-or-later
"""What runs beside Blender, in a process of its own: ``python -I worker.py FOLDER PATH...``.

The folder holds ``job.pickle``: the name of a function of this file and its arguments. What the function returns, or why
it failed, goes to ``result.pickle``; the stage and the share that is done go to standard output, a line each.
"""

from __future__ import annotations

import json
import os
import pickle
import sys
from pathlib import Path

#: Marks of an error that are handed over beside its message.
ERROR_FIELDS = ("code", "stage", "elements", "hint", "findings")


def told(stage: str, fraction: float) -> None:
    """Passes progress on. Where nobody listens any more, this ends the work."""
    print(json.dumps([stage, fraction]), flush=True)


def surface(mesh: dict, repair: bool):
    """The surface of a mesh as ``reading.Geometry.arrays`` has it."""
    import numpy as np
    import seamstress_mesh as sm

    polygons = mesh["corners"].reshape(len(mesh["sizes"]), -1) if is_uniform(mesh["sizes"]) else None
    if polygons is None:
        polygons = np.split(mesh["corners"], np.cumsum(mesh["sizes"])[:-1])
    return sm.Surface(mesh["positions"], polygons, repair=repair)


def is_uniform(sizes) -> bool:
    """Whether all polygons have the same number of corners."""
    return len(sizes) > 0 and sizes.min() == sizes.max()


def corners_of(mesh: dict, made):
    """The corner of the mesh that each corner of the surface's triangles is (m, 3)."""
    import numpy as np

    sizes, corners = mesh["sizes"], mesh["corners"].astype(np.int64)
    n = len(mesh["positions"])
    keys = np.repeat(np.arange(len(sizes)), sizes) * n + corners
    order = np.argsort(keys)
    wanted = (made.face_origin[:, None] * n + made.vertex_origin[made.faces]).ravel()
    found = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(order) - 1)]
    # A repair may have put another vertex at the place of the corner: the nearest of the polygon.
    starts = np.concatenate([[0], np.cumsum(sizes)])
    for at in np.flatnonzero(keys[found] != wanted):
        face = made.face_origin[at // 3]
        among = np.arange(starts[face], starts[face + 1])
        away = mesh["positions"][corners[among]] - made.vertices[made.faces.ravel()[at]]
        found[at] = among[np.argmin((away**2).sum(axis=1))]
    return found.reshape(-1, 3)


def guided(options: dict, sizes, strokes) -> dict:
    """Options with relative edge lengths at the vertices, if there are any, and segments of strokes (s, 2, 3), as files."""
    import numpy as np

    options = {"directions": [], **options}
    if sizes is not None:
        np.savetxt("sizes.csv", sizes)
        options["sizes"] = "csv:sizes.csv"
    if strokes is not None and len(strokes):
        ends = "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in strokes.reshape(-1, 3).tolist())
        lines = "".join(f"l {2 * k + 1} {2 * k + 2}\n" for k in range(len(strokes)))
        Path("strokes.obj").write_text(ends + lines)
        options["directions"] = [*options["directions"], "strokes:strokes.obj"]
    return options


def quads(mesh: dict, repair: bool, options: dict, values: list, sizes=None, strokes=None) -> dict:
    """A quad mesh, and what the mesh carries: pairs of what values are on, and a row for each element."""
    made = surface(mesh, repair).quad_mesh(**guided(options, sizes, strokes), progress=told)
    return {
        "vertices": made.vertices,
        "quads": made.quads,
        "values": [made.transfer(rows, on) for on, rows in values],
        "report": made.report,
    }


def seamless(mesh: dict, repair: bool, options: dict, strokes=None) -> dict:
    """The UV of every corner of a seamless map, and its cones by the mesh's own vertices."""
    import numpy as np

    made = surface(mesh, repair).parametrize(**guided(options, None, strokes), progress=told)
    corners = corners_of(mesh, made.surface)
    uv = np.zeros((len(mesh["corners"]), 2))
    uv[corners] = unfolded(made.uv[made.face_uv], corners, made.surface.face_origin)
    cones = np.column_stack([made.surface.vertex_origin[made.cones[:, 0]], made.cones[:, 1]])
    return {"uv": uv, "cones": cones, "report": made.report}


def unfolded(uv, corners, polygon):
    """The UVs of triangles (m, 3, 2) without seams inside polygons: there all triangles go on from the first.

    It is the same map. Triangles may be turned by quarters and shifted as they go over a seam.
    """
    import numpy as np

    uv = uv.copy()
    n = corners.max() + 1
    low, high = np.full((n, 2), np.inf), np.full((n, 2), -np.inf)
    np.minimum.at(low, corners, uv)
    np.maximum.at(high, corners, uv)
    is_torn = (low != high).any(axis=1)[corners].any(axis=1)
    order = np.argsort(polygon, kind="stable")
    starts = np.searchsorted(polygon[order], np.unique(polygon[is_torn]), side="left")
    ends = np.searchsorted(polygon[order], np.unique(polygon[is_torn]), side="right")
    for start, end in zip(starts, ends):
        first, *others = order[start:end]
        placed = {corner: place for corner, place in zip(corners[first], uv[first])}
        while others:
            for triangle in others:
                shared = [k for k in range(3) if corners[triangle][k] in placed]
                if len(shared) >= 2:
                    break
            else:
                break
            others.remove(triangle)
            here = uv[triangle] @ [1.0, 1j]
            there = np.array([placed[corners[triangle][k]] for k in shared[:2]]) @ [1.0, 1j]
            a, b = here[shared[:2]]
            turn = 1j ** round(np.angle((there[1] - there[0]) / (b - a)) / (np.pi / 2))
            moved = turn * (here - a) + there[0]
            uv[triangle] = np.column_stack([moved.real, moved.imag])
            placed.update({corner: place for corner, place in zip(corners[triangle], uv[triangle]) if corner not in placed})
            uv[triangle] = [placed[corner] for corner in corners[triangle]]
    return uv


def check(mesh: dict, uv, tolerance: float) -> dict:
    """What is wrong with a mesh; if nothing is, also with its UVs."""
    import seamstress_mesh as sm

    try:
        made = surface(mesh, False)
    except sm.InputError as error:
        return {"findings": error.findings, "report": None, "message": str(error)}
    if uv is None:
        return {"findings": made.report["warnings"], "report": None, "message": None}
    verdict = made.certify(uv[corners_of(mesh, made)], tolerance=tolerance, progress=told)
    return {"findings": verdict.violations, "report": verdict.report, "message": None}


def main() -> None:
    folder, *paths = sys.argv[1:]
    sys.path[:0] = paths
    if sys.platform == "linux":
        # Where memory runs out, the system ends this process rather than Blender.
        Path("/proc/self/oom_score_adj").write_text("1000")
    # Files of the job have no other place.
    os.chdir(folder)
    name, arguments = pickle.loads(Path("job.pickle").read_bytes())
    try:
        result = {"result": globals()[name](**arguments)}
    except BrokenPipeError:
        os._exit(1)
    except MemoryError:
        # There may be too little left to say more.
        raise
    except Exception as error:
        fields = {field: getattr(error, field, None) for field in ERROR_FIELDS}
        # The hint is about keywords of Python.
        message = str(error.args[0]) if fields["code"] else f"{type(error).__name__}: {error}"
        result = {"error": {"message": message, **fields}}
    partial = Path("result.partial")
    partial.write_bytes(pickle.dumps(result))
    partial.replace("result.pickle")


if __name__ == "__main__":
    main()
