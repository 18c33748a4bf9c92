"""Small meshes for tests, made by code."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def sphere(rings: int = 8, around: int = 12) -> tuple[Floats, Ints]:
    """A sphere of two poles and rings."""
    heights, angles = np.pi * np.arange(1, rings) / rings, 2 * np.pi * np.arange(around) / around
    h, a = np.meshgrid(heights, angles, indexing="ij")
    inner = np.stack([np.sin(h) * np.cos(a), np.sin(h) * np.sin(a), np.cos(h)], -1).reshape(-1, 3)
    vertices = np.vstack([[0, 0, 1], inner, [0, 0, -1]])
    south = len(vertices) - 1

    def at(ring: int, k: int) -> int:
        return 1 + ring * around + k % around

    faces = [(0, at(0, k), at(0, k + 1)) for k in range(around)]
    for r in range(rings - 2):
        for k in range(around):
            a0, a1, b0, b1 = at(r, k), at(r, k + 1), at(r + 1, k), at(r + 1, k + 1)
            faces += [(a0, b0, b1), (a0, b1, a1)]
    faces += [(at(rings - 2, k), south, at(rings - 2, k + 1)) for k in range(around)]
    return vertices, np.array(faces)


def cube(n: int = 4) -> tuple[Floats, list[tuple[int, ...]]]:
    """The unit cube, each side n by n quads."""
    points: dict[tuple[int, ...], int] = {}
    quads = []
    for axis in range(3):
        for side in (0, n):
            for i in range(n):
                for j in range(n):
                    corners = []
                    for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        point = [0, 0, 0]
                        point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3] = side, i + di, j + dj
                        corners.append(points.setdefault(tuple(point), len(points)))
                    quads.append(tuple(corners if side else corners[::-1]))
    return np.array(list(points), dtype=float) / n, quads


def grid(n: int = 8) -> tuple[Floats, Ints]:
    """A flat square of n by n quads, each split."""
    x, y = np.meshgrid(np.arange(n + 1), np.arange(n + 1))
    vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)]) / n
    at = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = at[:-1, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, 1:].ravel(), at[1:, :-1].ravel()
    return vertices, np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def is_seamless(faces: Ints, uv: Floats, face_uv: Ints) -> bool:
    """Positive triangles, and edges whose two images differ by a quarter turn and a shift."""
    corners = uv[face_uv]
    d, e = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    if not (d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0] > 0).all():
        return False
    sides: dict[tuple[int, int], complex] = {}
    for face, triangle in zip(faces, corners):
        for k in range(3):
            a, b = int(face[k]), int(face[(k + 1) % 3])
            way = complex(*(triangle[(k + 1) % 3] - triangle[k]))
            if (b, a) in sides:
                turn = -way / sides[(b, a)]
                if min(abs(turn - 1j**q) for q in range(4)) > 1e-9:
                    return False
            sides[(a, b)] = way
    return True
