"""What is made of a surface. All of it pickles: arrays, the report, and the file that it would be written to."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

import numpy as np

from . import _attributes, _native
from ._arrays import Floats, Ints, float_rows, int_rows, value_rows
from ._errors import InputError
from ._html import figure, page

if TYPE_CHECKING:
    from typing import Literal

    import numpy.typing as npt
    from typing_extensions import Self

    from ._attributes import Attribute
    from ._surface import Surface

Native = TypeVar("Native", _native.Map, _native.Quads)


class _Made(Generic[Native]):
    """A result with its compiled half, which draws and writes it; after pickling with its OBJ file instead."""

    #: What the library calls its files.
    _kind: ClassVar[str]
    _made: Native | bytes

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes it in the format that the ending of the name says, the bytes of the command line; the file appears when
        it is complete. After pickling that is OBJ alone.
        """
        name = os.fspath(path)
        _native.write_file(name, self._kind, self._file(name))

    def _file(self, name: str) -> bytes:
        if not isinstance(self._made, bytes):
            return self._made.file(name)
        if not name.lower().removesuffix(".gz").endswith(".obj"):
            raise InputError("what was pickled is written as OBJ alone", "unwritable")
        return self._made

    def _drawn(self) -> Native:
        """What draws it."""
        if isinstance(self._made, bytes):
            raise InputError("what was pickled has no pictures; draw them before", "no-picture")
        return self._made

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_made": self._file("made.obj")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)


@dataclass(frozen=True, eq=False, repr=False)
class SeamlessMap(_Made[_native.Map]):
    """A certified seamless map: no triangle is flipped, every seam fits, every cone angle is a multiple of 90 degrees."""

    #: The surface it is of.
    surface: Surface
    #: UVs (k, 2), mesh units: one for each vertex, and one more wherever a seam gives it another.
    uv: Floats
    #: For each triangle of the surface the UVs of its corners (m, 3).
    face_uv: Ints
    #: Interior vertices with an angle other than a full turn, and their indices in quarters (n, 2).
    cones: Ints
    #: Edges across which the UVs jump: their ends, and the quarter turns from left to right (n, 3).
    seams: Ints
    #: Feature edges on the axes, by their ends (n, 2).
    aligned_edges: Ints
    #: How it was made, and how good it is, as the command line reports it.
    report: dict[str, Any]
    _made: _native.Map | bytes
    _kind = "map"

    @classmethod
    def _of(cls, surface: Surface, made: _native.Map) -> Self:
        return cls(
            surface,
            float_rows(made.uv(), 2),
            int_rows(made.face_uv(), 3),
            int_rows(made.cones(), 2, signed=True),
            int_rows(made.seams(), 3, signed=True),
            int_rows(made.aligned_edges(), 2),
            json.loads(made.report()),
            made,
        )

    def write(self, path: str | os.PathLike[str], *, uv_set: Literal["first", "second"] = "first") -> None:
        """Writes it as OBJ, PLY or GLB, the bytes of the command line; the file appears when it is complete. In GLB its UVs are
        the ``first`` set or, after the first of the mesh, the ``second``. After pickling it is written as OBJ alone.
        """
        if uv_set not in ("first", "second"):
            raise InputError(f"uv_set: {uv_set!r} is neither first nor second")
        name, made = os.fspath(path), self._made
        content = self._file(name) if isinstance(made, bytes) else made.file(name, uv_set)
        _native.write_file(name, self._kind, content)

    @property
    def corner_uv(self) -> Floats:
        """The UV of every corner (3m, 2), three a triangle."""
        return self.uv[self.face_uv.ravel()]

    @property
    def certificate(self) -> dict[str, Any]:
        """What was checked."""
        certificate: dict[str, Any] = self.report["certificate"]
        return certificate

    def field(self) -> CrossField:
        """The cross field that its axes are on the surface."""
        if isinstance(self._made, bytes):
            return self.surface.field(self.uv, self.face_uv)
        return CrossField._of(self.surface, self._made.field())

    def pictures(self, **options: Any) -> dict[str, bytes]:
        """Pictures as PNG files: ``front``, ``back`` and ``layout``. Options are those of the command line's pictures."""
        view = {name: options.pop(name) for name in ("view", "up") if name in options}
        settings = {name.replace("texture_", ""): value for name, value in options.items()}
        drawn = self._drawn().pictures(json.dumps({**settings, "view": view}))
        return dict(zip(("front", "back", "layout"), drawn))

    def __repr__(self) -> str:
        tau = figure(self.report["distortion"]["tau"])
        return f"<{type(self).__name__}: {len(self.face_uv)} triangles, {len(self.cones)} cones, tau {tau}>"

    def _repr_html_(self) -> str:
        pictures = [] if isinstance(self._made, bytes) else list(self.pictures().values())
        return page(repr(self).strip("<>"), self._figures(), pictures[::2])

    def _figures(self) -> dict[str, Any]:
        distortion, certificate = self.report["distortion"], self.certificate
        return {
            "tau": figure(distortion["tau"]),
            "symmetric Dirichlet": figure(distortion["symmetric_dirichlet"]),
            "flipped": distortion["flipped"],
            "cones": len(self.cones),
            "seam edges": len(self.seams),
            "seams fit to": f"{certificate['seam_residual']:.1e} edge lengths",
            "angles fit to": f"{certificate['angle_error']:.1e} radians",
        }


class IntegerGridMap(SeamlessMap):
    """A seamless map whose unit grid closes up over the surface: translations and cones are whole numbers, UVs in cells."""

    def _figures(self) -> dict[str, Any]:
        grid = self.report["grid"]
        return {"quads": figure(grid["quads"]), "edge length": figure(grid["edge_length"]), **super()._figures()}


@dataclass(frozen=True, eq=False, repr=False)
class QuadMesh(_Made[_native.Quads]):
    """A mesh of quads, an oriented manifold, and where each vertex comes from."""

    #: The surface it was made of.
    surface: Surface
    #: Positions (n, 3).
    vertices: Floats
    #: Vertices of the quads (k, 4), counter-clockwise as the triangles of the surface.
    quads: Ints
    #: Interior vertices with another number of quads than four, and their indices: 4 less that number (n, 2).
    irregular: Ints
    #: The triangle of the surface at which the map has each vertex (n,), before vertices were moved to untangle quads.
    source_face: Ints
    #: The barycentric weights of that point (n, 3).
    source_bary: Floats
    #: How it was made, and what it is, as the command line reports it.
    report: dict[str, Any]
    _made: _native.Quads | bytes
    _kind = "quads"

    @classmethod
    def _of(cls, surface: Surface, made: _native.Quads) -> QuadMesh:
        return cls(
            surface,
            float_rows(made.vertices(), 3),
            int_rows(made.quads(), 4),
            int_rows(made.irregular(), 2, signed=True),
            int_rows(made.source_face()),
            float_rows(made.source_bary(), 3),
            json.loads(made.report()),
            made,
        )

    def transfer(self, values: npt.ArrayLike, on: Literal["vertex", "corner", "face"] = "vertex") -> npt.NDArray[Any]:
        """Values of the input of the surface, brought over to the quads.

        Values have a row for each vertex, corner or polygon of what the surface was made of, in its order; those of
        corners may also be (m, k, d). The result has a row for each vertex (n, ...), corner (k, 4, ...) or quad (k, ...).
        Real numbers are interpolated, on faces averaged by area; whole numbers, truth values and strings stand for
        something and are never mixed: a quad has the one with the largest share. At corners a quad takes the values of
        one side of a seam, the one that its middle lies on, continued linearly.

        Raises ``InputError`` if there are not as many rows.
        """
        if on not in ("vertex", "corner", "face"):
            raise InputError(f"on: {on!r} is none of vertex, corner and face")
        if isinstance(self._made, bytes):
            raise InputError("what was pickled takes no values; transfer them before")
        rows, shape, labels = value_rows(values, on)
        carried = self._made.transfer(rows.tobytes(), rows.shape[1], on, labels is not None)
        leading = {"vertex": (len(self.vertices),), "corner": (*self.quads.shape,), "face": (len(self.quads),)}[on]
        found = float_rows(carried, rows.shape[1])
        return found.reshape(leading + shape) if labels is None else labels[found[:, 0].astype(np.int64)].reshape(leading + shape)

    @property
    def attributes(self) -> list[Attribute]:
        """What the surface carries, on the quads: what has one value at each vertex on vertices, else on corners or quads."""
        if isinstance(self._made, bytes):
            raise InputError("what was pickled has no attributes; ask for them before")
        return _attributes.told(self._made.attributes())

    def picture(self, **options: Any) -> bytes:
        """A picture with its irregular vertices, as a PNG file. Options are those of the command line's pictures."""
        return self._drawn().picture(json.dumps(options))

    def __repr__(self) -> str:
        return f"<QuadMesh: {len(self.quads)} quads, {len(self.irregular)} irregular vertices>"

    def _repr_html_(self) -> str:
        pictures = [] if isinstance(self._made, bytes) else [self.picture()]
        quads = self.report["quads"]
        figures = {
            "quads": quads["count"],
            "irregular vertices": len(self.irregular),
            "boundary loops": quads.get("boundary_loops"),
            "components": quads.get("components"),
            "left out at boundaries": quads["trimmed"],
        }
        return page(repr(self).strip("<>"), figures, pictures)


@dataclass(frozen=True, eq=False, repr=False)
class CrossField:
    """Four directions at right angles on each triangle, and a matching across each edge."""

    #: The surface it is on.
    surface: Surface
    #: The four unit directions on each triangle (m, 4, 3), counter-clockwise, the first along ``u`` of the map.
    directions: Floats
    #: Each edge: its ends as the left triangle has them, the left and the right triangle (-1 beyond the boundary), and
    #: the quarter turns from left to right, 0 to 3 (e, 5).
    matchings: Ints
    #: Vertices with an index other than zero, in quarters of a turn (n, 2).
    cones: Ints
    #: Its indices, as the command line reports them.
    report: dict[str, Any]

    @classmethod
    def _of(cls, surface: Surface, made: _native.CrossField) -> CrossField:
        return cls(
            surface,
            float_rows(made.directions(), 4, 3),
            int_rows(made.matchings(), 5, signed=True),
            int_rows(made.cones(), 2, signed=True),
            json.loads(made.report()),
        )

    def __repr__(self) -> str:
        return f"<CrossField: {len(self.directions)} triangles, {len(self.cones)} cones>"


@dataclass(frozen=True, eq=False, repr=False)
class FeatureCurves:
    """Feature edges and the curves that they form."""

    #: The surface they are on.
    surface: Surface
    #: The edges by their ends (n, 2).
    edges: Ints
    #: Vertices at which curves meet or turn, or end on the boundary (n,).
    corners: Ints
    #: Vertices at which curves end inside the surface (n,).
    open_ends: Ints
    #: Sources, curves and lengths, as the command line reports them.
    report: dict[str, Any]

    @classmethod
    def _of(cls, surface: Surface, made: _native.Curves) -> FeatureCurves:
        arrays = (int_rows(made.edges(), 2), int_rows(made.corners()), int_rows(made.open_ends()))
        return cls(surface, *arrays, json.loads(made.report()))

    def __repr__(self) -> str:
        return f"<FeatureCurves: {len(self.edges)} edges in {len(self.report['curves'])} curves>"


@dataclass(frozen=True, eq=False, repr=False)
class Verdict:
    """What was found of a map from anywhere. True if all that was asked for is certified."""

    #: Whether all that was asked for is certified.
    is_passed: bool
    #: What was checked, and every violation, as the command line reports it.
    report: dict[str, Any]

    @property
    def certificate(self) -> dict[str, Any] | None:
        """What was checked, if it is a seamless map."""
        return self.report.get("certificate")

    @property
    def violations(self) -> list[dict[str, Any]]:
        """Why something that was asked for is not certified, one by one."""
        kinds = ("violations", "alignment_violations", "integer_violations")
        return [violation for kind in kinds for violation in self.report.get(kind, [])]

    def __bool__(self) -> bool:
        return self.is_passed

    def __repr__(self) -> str:
        text = "certified" if self.is_passed else f"{len(self.violations)} violations"
        return f"<Verdict: {text}>"


@dataclass(frozen=True, eq=False, repr=False)
class Measurements:
    """Every measure of distortion over a map."""

    #: The value of every triangle (m,), by the name of the measure; not a number where the surface has no area.
    values: dict[str, Floats]
    #: Means, maxima and percentiles, as the command line reports them.
    report: dict[str, Any]

    @classmethod
    def _of(cls, report: str, values: list[bytearray]) -> Measurements:
        decoded: dict[str, Any] = json.loads(report)
        names = (measure["measure"] for measure in decoded["measures"])
        return cls(dict(zip(names, map(float_rows, values))), decoded)

    def __getitem__(self, name: str) -> dict[str, Any]:
        """The figures of one measure."""
        measures: list[dict[str, Any]] = self.report["measures"]
        return next(measure for measure in measures if measure["measure"] == name)

    def __repr__(self) -> str:
        return f"<Measurements: {', '.join(self.values)}>"
