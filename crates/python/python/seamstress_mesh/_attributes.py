"""What a mesh carries beside its shape."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from ._arrays import float_rows, value_rows
from ._errors import InputError

if TYPE_CHECKING:
    from typing import Literal

    import numpy.typing as npt

_ON = ("vertex", "corner", "face")
_KINDS = ("number", "label", "uv", "normal", "color")


@dataclass(frozen=True, eq=False)
class Attribute:
    """Values of the vertices, corners or faces of a mesh, such as a colour, a set of UVs, or a material."""

    #: ``material``, ``object``, ``group`` and ``smoothing`` for labels of faces, else as a file or a user calls it.
    name: str
    on: Literal["vertex", "corner", "face"]
    #: A row for each vertex, corner or polygon, in their order: (n,) or (n, d).
    values: npt.NDArray[Any]
    #: How values are mixed and written. Labels are whole numbers or strings that stand for something, and never mixed.
    #: If none is said, real numbers are numbers and all else is labels.
    kind: Literal["number", "label", "uv", "normal", "color"] | None = None


def told(found: list[_native._Attribute]) -> list[Attribute]:
    """Attributes from the compiled half."""
    attributes = []
    for name, on, kind, width, content, names in found:
        values: npt.NDArray[Any] = float_rows(content, width)
        if width == 1:
            values = values[:, 0]
        if kind == "label":
            values = values.astype(np.int64)
        if names:
            values = np.array(names)[values]
        attributes.append(Attribute(name, on, values, kind))  # type: ignore[arg-type]
    return attributes


def given(attributes: Iterable[Attribute]) -> list[_native._Given]:
    """Attributes for the compiled half."""
    return [_given(attribute) for attribute in attributes]


def _given(attribute: Attribute) -> _native._Given:
    name, on, kind = attribute.name, attribute.on, attribute.kind
    if on not in _ON or kind not in (None, *_KINDS):
        raise InputError(f"{name}: on {on!r} of kind {kind!r} is none of {', '.join(_ON)} and {', '.join(_KINDS)}")
    rows, _, labels = value_rows(attribute.values, on)
    if labels is None:
        return name, on, kind or "number", rows.shape[1], rows.tobytes(), []
    if labels.dtype.kind in "SU":
        return name, on, "label", 1, rows.tobytes(), [str(label) for label in labels]
    numbers = labels[rows[:, 0].astype(np.int64)].astype(np.float64).reshape(len(rows), -1)
    return name, on, kind or "label", numbers.shape[1], numbers.tobytes(), []
