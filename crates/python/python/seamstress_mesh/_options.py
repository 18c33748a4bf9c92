"""Options: keywords with the names of the command line's flags, given to the library as JSON.

What is not given is left to the library, which alone knows the defaults. Their texts are those of the command line.
"""

from __future__ import annotations

import inspect
import json
import os
import textwrap
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Callable, Optional, TypedDict, TypeVar, Union

import numpy as np

from . import _native
from ._errors import InputError

if TYPE_CHECKING:
    import numpy.typing as npt

#: Called with the stage and the share of it that is done; ``False`` stops the work. ``True`` shows a bar.
Progress = Union[bool, Callable[[str, float], Optional[bool]], None]
#: A source of features or several, by the names of ``--features``; or edges (n, 2) by their ends.
Features = Union[str, "Iterable[str]", "npt.ArrayLike", None]


class RunOptions(TypedDict, total=False):
    """How a call is run. No result depends on it."""

    #: Seconds after which it is stopped.
    timeout: float | None
    #: Bytes; work that is expected to take more memory is refused before it starts.
    memory_limit: float | None
    #: Number of threads; all cores if none is given.
    threads: int | None
    progress: Progress


class MapOptions(RunOptions, total=False):
    """Options of seamless maps."""

    features: Features
    align_boundary: bool
    features_strict: bool
    corner_angle: float
    align: float | None
    directions: str | Iterable[str]
    adaptive: float
    sizes: str | Iterable[str]
    min_edge: float | None
    max_edge: float | None
    size_growth: float
    symmetry: str
    pack: int | None
    pack_margin: int
    cone_bias: float
    cone_price: float | None
    corner_weight: float
    fast: bool
    no_tau_polish: bool
    polish_time: float | None
    max_energy_rise: float
    objective: str | None


class SurfaceOptions(TypedDict, total=False):
    """How a surface is made of what is read."""

    repair: bool
    weld: str | float
    format: str | None


_RUN = tuple(RunOptions.__annotations__)


def _sources(features: Features) -> list[str]:
    if features is None:
        return []
    if isinstance(features, str):
        return [features]
    if isinstance(features, (int, float)):
        return [f"angle:{features}"]
    listed: list[Any] = list(features) if isinstance(features, Iterable) else [features]
    if all(isinstance(source, str) for source in listed):
        return listed
    edges = np.asarray(listed)
    if edges.ndim != 2 or edges.shape[1] != 2 or edges.dtype.kind not in "iu":
        raise InputError("features are names of sources, or edges (n, 2) by their ends", "bad-features")
    return ["edges:" + ",".join(f"{a}-{b}" for a, b in edges)]


def feature_sources(features: Features, align_boundary: bool = False) -> list[str] | None:
    """Sources of features as the library has them; none leaves the choice to it."""
    if features is None and not align_boundary:
        return None
    sources = _sources(features)
    boundary = ["boundary"] if align_boundary else []
    return [source for source in sources if source != "none"] + boundary


def known(options: Mapping[str, Any], kind: Any) -> dict[str, Any]:
    """Options by their names, which have to be those of a kind."""
    for name in options:
        if name not in kind.__annotations__:
            raise TypeError(f"got an unexpected keyword argument {name!r}")
    return dict(options)


def chosen(**options: Any) -> dict[str, Any]:
    """The options that are not left to the library."""
    return {name: value for name, value in options.items() if value is not None}


def map_options(given: Mapping[str, Any]) -> dict[str, Any]:
    """The options of a map as the library has them, without those of the run."""
    options = known(given, MapOptions)
    settings = {name: value for name, value in options.items() if name not in (*_RUN, "align_boundary")}
    for name in ("directions", "sizes"):
        if isinstance(options.get(name), str):
            settings[name] = [options[name]]
    settings["features"] = feature_sources(options.get("features"), options.get("align_boundary", False))
    return settings


def grid_size(quads: float | None, edge_length: float | None, scale: float | None) -> dict[str, float]:
    """How fine a grid is to be: one of the three."""
    given = {"quads": quads, "edge-length": edge_length, "scale": scale}
    sizes = {name: float(size) for name, size in given.items() if size is not None}
    if len(sizes) != 1:
        raise InputError("give one of `quads`, `edge_length` and `scale`")
    return sizes


def surface_options(given: Mapping[str, Any]) -> str:
    """The options of a surface as JSON."""
    options = known(given, SurfaceOptions)
    weld = options.get("weld")
    if isinstance(weld, (int, float)):
        options["weld"] = {"within": weld}
    return to_json(options)


def to_json(options: dict[str, Any] | list[Any]) -> str:
    """Options as JSON; numbers and paths of any kind are allowed."""

    def plain(value: Any) -> Any:
        if isinstance(value, np.generic):
            return value.item()
        if isinstance(value, os.PathLike):
            return os.fspath(value)
        raise InputError(f"{value!r} is no value of an option")

    try:
        return json.dumps(options, default=plain, allow_nan=False)
    except ValueError as error:
        raise InputError("an option is not a finite number") from error


Method = TypeVar("Method", bound=Callable[..., Any])


def documented(command: str, *names: str) -> Callable[[Method], Method]:
    """Adds the help texts of the command's flags of these names to the documentation of a method."""

    def add(method: Method) -> Method:
        flags = {name: (text, default) for name, text, default in _native.flags(command)}
        lines = []
        for name in names:
            text, default = flags[name]
            shown = f"{name} [default: {default}]" if default else name
            lines.append(f"    {shown}\n{textwrap.indent(textwrap.fill(text, 100) if len(text) < 800 else text, ' ' * 8)}")
        method.__doc__ = f"{inspect.cleandoc(method.__doc__ or '')}\n\nOptions:\n" + "\n".join(lines)
        return method

    return add
