"""Arrays in and out: what people have as meshes and maps, and the bytes of the compiled half."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from ._errors import InputError

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]
#: UVs and the three of each face, as bytes.
MapBytes = "tuple[bytes, bytes]"

#: Cells of meshio that are faces of a surface.
_FACES = {"triangle": 3, "quad": 4, "polygon": 0}


def floats(values: npt.ArrayLike, shape: tuple[int, ...], name: str) -> Floats:
    """An array of numbers of this shape; -1 stands for any length."""
    array = np.asarray(values)
    if array.dtype.kind not in "biuf":
        raise InputError(f"{name} are not real numbers: their dtype is {array.dtype}", "not-a-surface")
    fits = array.ndim == len(shape) and all(n in (-1, m) for n, m in zip(shape, array.shape))
    if not fits:
        wanted = ", ".join("n" if n < 0 else str(n) for n in shape)
        raise InputError(f"{name} have the shape {array.shape}, not ({wanted})", "not-a-surface")
    return np.ascontiguousarray(array, dtype=np.float64)


def ids(values: npt.ArrayLike, name: str) -> npt.NDArray[np.uint32]:
    """An array of whole numbers from 0, of any numeric dtype."""
    array = np.asarray(values)
    if array.dtype.kind not in "biuf":
        raise InputError(f"{name} are not whole numbers: their dtype is {array.dtype}", "not-a-surface")
    # In a dtype of its own, since NumPy 2.0 may crash when it compares narrow ones with large numbers; what is too large
    # for it becomes negative.
    numbers = np.ascontiguousarray(array, dtype=np.float64 if array.dtype.kind == "f" else np.int64)
    good = (numbers >= 0) & (numbers < 2**32 - 1) & (numbers == np.floor(numbers))
    if not good.all():
        face = int(np.argwhere(~good)[0, 0])
        text = f"{name}: {array[~good][0]} in row {face} is no whole number from 0"
        raise InputError(text, "not-a-surface", elements={"vertices": [], "edges": [], "faces": [face]})
    return numbers.astype(np.uint32)


def polygons(faces: Any) -> tuple[bytes, bytes]:
    """The numbers of corners and the corners of faces: an (m, k) array, or a list of polygons of any length."""
    try:
        array = np.asarray(faces)
    except ValueError:
        # Polygons of different lengths.
        array = np.empty(0, dtype=object)
    if array.dtype != object and array.ndim == 2:
        sizes = np.full(array.shape[0], array.shape[1], dtype=np.uint32)
        return sizes.tobytes(), ids(array, "faces").tobytes()
    if array.dtype != object and not (array.ndim == 1 and array.size == 0):
        raise InputError(f"faces have the shape {array.shape}, not (m, 3) or (m, 4)", "not-a-surface")
    lists: Sequence[Any] = [np.asarray(polygon) for polygon in faces]
    if any(polygon.ndim != 1 for polygon in lists):
        raise InputError("faces are neither an array nor a list of polygons", "not-a-surface")
    sizes = np.array([len(polygon) for polygon in lists], dtype=np.uint32)
    corners = [ids(polygon, f"face {face}") for face, polygon in enumerate(lists)]
    return sizes.tobytes(), b"".join(polygon.tobytes() for polygon in corners)


def mesh_arrays(mesh: Any) -> tuple[Any, Any]:
    """Vertices and faces of a mesh: of trimesh, of meshio, or anything with ``vertices`` and ``faces``."""
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return mesh.vertices, mesh.faces
    if hasattr(mesh, "points") and hasattr(mesh, "cells"):
        blocks = [block for block in mesh.cells if block.type.rstrip("0123456789") in _FACES]
        if not blocks:
            raise InputError("the mesh has no triangles, quads or polygons", "not-a-surface")
        points = np.asarray(mesh.points)
        if points.ndim == 2 and points.shape[1] == 2:
            points = np.column_stack([points, np.zeros(len(points))])
        if len(blocks) == 1:
            return points, blocks[0].data
        return points, [polygon for block in blocks for polygon in block.data]
    raise InputError(
        f"{type(mesh).__name__} is no mesh: give vertices and faces, a path, or an object that has both", "not-a-surface"
    )


def map_bytes(uv: npt.ArrayLike, face_uv: npt.ArrayLike | None, faces: Ints, n_vertices: int) -> tuple[bytes, bytes]:
    """UVs and the three of each face. Without these, UVs are one a vertex (n, 2), or one a corner: (m, 3, 2) or (3m, 2)."""
    array = np.asarray(uv)
    if array.ndim == 3:
        array = floats(array, (-1, 3, 2), "UVs").reshape(-1, 2)
    array = floats(array, (-1, 2), "UVs")
    if face_uv is not None:
        corners = ids(face_uv, "face UVs")
        if corners.ndim != 2 or corners.shape[1] != 3:
            raise InputError(f"face UVs have the shape {corners.shape}, not (m, 3)", "not-a-map")
    elif len(array) == 3 * len(faces) and np.ndim(uv) == 3 or len(array) != n_vertices:
        corners = np.arange(len(array) // 3 * 3, dtype=np.uint32).reshape(-1, 3)
    else:
        corners = faces.astype(np.uint32)
    return array.tobytes(), np.ascontiguousarray(corners).tobytes()


def value_rows(values: npt.ArrayLike, on: str) -> tuple[Floats, tuple[int, ...], npt.NDArray[Any] | None]:
    """Values of elements as rows of real numbers, the shape of the value of one, and the labels that numbers stand for."""
    array = np.asarray(values)
    if on == "corner" and array.ndim == 3:
        array = array.reshape(-1, array.shape[2])
    if array.ndim not in (1, 2) or 0 in array.shape[1:]:
        raise InputError(f"values have the shape {array.shape}, not (n,) or (n, d)")
    shape = array.shape[1:]
    if array.dtype.kind == "f":
        return floats(array.reshape(len(array), -1), (-1, -1), "values"), shape, None
    if array.dtype.kind not in "biuSU":
        raise InputError(f"values are neither numbers nor strings: their dtype is {array.dtype}")
    labels, numbers = np.unique(array, axis=0, return_inverse=True)
    return numbers.reshape(-1, 1).astype(np.float64), shape, labels


def float_rows(content: bytearray, *shape: int) -> Floats:
    """An array of float64 from the compiled half."""
    return np.frombuffer(content, dtype=np.float64).reshape(-1, *shape) if shape else np.frombuffer(content)


def int_rows(content: bytearray, *shape: int, signed: bool = False) -> Ints:
    """An array of int64 from 32-bit numbers of the compiled half."""
    array = np.frombuffer(content, dtype=np.int32 if signed else np.uint32).astype(np.int64)
    return array.reshape(-1, *shape) if shape else array
