"""The surface, from which everything is made."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

from . import _attributes, _native
from ._arrays import Floats, Ints, float_rows, floats, int_rows, map_bytes, mesh_arrays, polygons
from ._attributes import Attribute
from ._errors import InputError
from ._options import (
    Features,
    MapOptions,
    RunOptions,
    SurfaceOptions,
    chosen,
    documented,
    feature_sources,
    grid_size,
    known,
    map_options,
    surface_options,
    to_json,
)
from ._progress import running
from ._results import CrossField, FeatureCurves, IntegerGridMap, Measurements, QuadMesh, SeamlessMap, Verdict

if TYPE_CHECKING:
    from collections.abc import Iterable

    import numpy.typing as npt
    from typing_extensions import Unpack

_MAP = tuple(name for name in MapOptions.__annotations__ if name not in RunOptions.__annotations__)
_SURFACE = tuple(SurfaceOptions.__annotations__)


class Surface:
    """An oriented manifold of triangles with positions.

    Its triangles are the polygons of the input, split; vertices and faces keep their order, and nothing is moved. With
    repairs some may be gone or added: ``vertex_origin`` and ``face_origin`` tell where each comes from.
    """

    #: Positions (n, 3), mesh units.
    vertices: Floats
    #: Vertices of the triangles (m, 3).
    faces: Ints
    #: The vertex of the input that each vertex was (n,).
    vertex_origin: Ints
    #: The polygon of the input that each triangle is of (m,).
    face_origin: Ints
    #: Counts, topology, size, notes, warnings and repairs, as the command line reports them.
    report: dict[str, Any]

    @documented("map", *_SURFACE)
    def __init__(self, mesh: Any, faces: Any = None, **options: Unpack[SurfaceOptions]) -> None:
        """Makes a surface of vertices (n, 3) and faces: (m, 3), (m, 4), or a list of polygons of any length, counted from
        0, counter-clockwise seen from outside, of any numeric dtype and order. A path, or a mesh of trimesh or meshio,
        or anything with ``vertices`` and ``faces`` goes without faces.

        Raises ``InputError`` with every fault if it is no surface.
        """
        settings = surface_options(options)
        with running({}) as run:
            if faces is None and isinstance(mesh, (str, os.PathLike)):
                self._of(_native.Surface.read(os.fspath(mesh), settings, run))
                return
            if faces is None:
                mesh, faces = mesh_arrays(mesh)
            positions = floats(mesh, (-1, 3), "vertices")
            self._of(_native.Surface.of_polygons(positions.tobytes(), *polygons(faces), settings, run))

    def _of(self, native: _native.Surface) -> None:
        self._native = native
        self.vertices = float_rows(native.vertices(), 3)
        self.faces = int_rows(native.faces(), 3)
        self.vertex_origin = int_rows(native.input_vertices())
        self.face_origin = int_rows(native.input_faces())
        self.report = json.loads(native.report())

    @property
    def attributes(self) -> list[Attribute]:
        """What it carries beside its shape: UVs, colours, normals, materials, groups and other values, for the vertices,
        corners and polygons that it was made of.
        """
        return _attributes.told(self._native.attributes())

    def with_attributes(self, attributes: Iterable[Attribute]) -> Surface:
        """The same surface with these attributes and no others, for the vertices, corners and polygons that it was made of.
        They come over to quads and into files, and ``sizes`` may name them.

        Raises ``InputError`` if one has another number of rows.
        """
        changed = Surface.__new__(Surface)
        changed._of(self._native.with_attributes(_attributes.given(attributes)))
        return changed

    @documented("map", *_MAP)
    def parametrize(self, **options: Unpack[MapOptions]) -> SeamlessMap:
        """Makes a seamless map of low distortion by the direct method, and certifies it.

        Raises ``NoCertifiedMap`` where the method finds none that it can vouch for.
        """
        with running(options) as run:
            made = self._native.parametrize(to_json(map_options(options)), run)
        return SeamlessMap._of(self, made)

    @documented("integer", "quads", "edge_length", "scale", "rounding", "partial", "small_parts", *_MAP)
    def integer_map(
        self,
        quads: float | None = None,
        *,
        edge_length: float | None = None,
        scale: float | None = None,
        rounding: str | None = None,
        partial: bool = False,
        small_parts: str | None = None,
        **options: Unpack[MapOptions],
    ) -> IntegerGridMap:
        """Makes a seamless map whose cones suit the grid, and rounds it to an integer-grid map.

        One of ``quads``, ``edge_length`` and ``scale`` says how fine the grid is to be. Without ``features`` it follows
        those of ``auto``. Raises ``NoCertifiedMap`` where there is none.
        """
        parts = chosen(partial=partial, small_parts=small_parts)
        size = grid_size(quads, edge_length, scale)
        settings = chosen(size=size, rounding=rounding, parts=parts, map=map_options(options))
        with running(options) as run:
            made = self._native.integer_map(to_json(settings), run)
        return IntegerGridMap._of(self, made)

    @documented("integer", "quads", "edge_length", "scale", "rounding", "tolerance", "features")
    def integer_map_of(
        self,
        uv: npt.ArrayLike,
        face_uv: npt.ArrayLike | None = None,
        *,
        quads: float | None = None,
        edge_length: float | None = None,
        scale: float | None = None,
        rounding: str | None = None,
        tolerance: float | None = None,
        features: Features = None,
        align_boundary: bool = False,
        **run_options: Unpack[RunOptions],
    ) -> IntegerGridMap:
        """Rounds a seamless map of this surface, from anywhere, to an integer-grid map.

        Features that it has on its axes come to lie on lines of the grid; the others are dropped.
        """
        sources = feature_sources(features, align_boundary)
        size = grid_size(quads, edge_length, scale)
        settings = chosen(size=size, rounding=rounding, map={"features": sources})
        both = to_json([chosen(tolerance=tolerance), settings])
        with running(known(run_options, RunOptions)) as run:
            made = self._native.integer_map_of(self._given(uv, face_uv), both, run)
        return IntegerGridMap._of(self, made)

    @documented("quad", "quads", "edge_length", "scale", "raw", "smooth", "source_points", "partial", "small_parts", *_MAP)
    def quad_mesh(
        self,
        quads: float | None = None,
        *,
        edge_length: float | None = None,
        scale: float | None = None,
        raw: bool = False,
        smooth: int = 0,
        source_points: bool = False,
        partial: bool = False,
        small_parts: str | None = None,
        **options: Unpack[MapOptions],
    ) -> QuadMesh:
        """Makes a mesh of quads: a seamless map, rounded to an integer-grid map whose cells are extracted.

        One of ``quads``, ``edge_length`` and ``scale`` says how fine it is to be. Without ``features`` it follows those
        of ``auto``. Raises ``NoCertifiedMap`` where there is none.
        """
        shape = {"raw": raw, "smooth": smooth, "source_points": source_points}
        parts = chosen(partial=partial, small_parts=small_parts)
        size = grid_size(quads, edge_length, scale)
        settings = {"size": size, "shape": shape, "parts": parts, "map": map_options(options)}
        with running(options) as run:
            made = self._native.quad_mesh(to_json(settings), run)
        return QuadMesh._of(self, made)

    @documented("extract", "raw", "smooth", "source_points", "tolerance", "best_effort", "features")
    def extract_quads(
        self,
        uv: npt.ArrayLike,
        face_uv: npt.ArrayLike | None = None,
        *,
        raw: bool = False,
        smooth: int = 0,
        source_points: bool = False,
        tolerance: float | None = None,
        best_effort: bool = False,
        features: Features = None,
        **run_options: Unpack[RunOptions],
    ) -> QuadMesh:
        """Extracts the quads of an integer-grid map of this surface, made by any program, in grid units."""
        shape = {"raw": raw, "smooth": smooth, "source_points": source_points}
        settings = chosen(shape=shape, tolerance=tolerance, best_effort=best_effort)
        both = to_json([feature_sources(features) or [], settings])
        with running(known(run_options, RunOptions)) as run:
            made = self._native.extract_quads(self._given(uv, face_uv), both, run)
        return QuadMesh._of(self, made)

    @documented("lab optimize", "objective", "bound", "solver", "features_strict", "tolerance", "features")
    def optimize(
        self,
        uv: npt.ArrayLike | None = None,
        face_uv: npt.ArrayLike | None = None,
        *,
        objective: str | None = None,
        bound: float | None = None,
        solver: str | None = None,
        features_strict: bool = False,
        tolerance: float | None = None,
        features: Features = None,
        align_boundary: bool = False,
        **run_options: Unpack[RunOptions],
    ) -> SeamlessMap:
        """Minimises an objective over all maps with the matchings and cones of a seamless map; its seams may come to lie
        elsewhere. Without a map the surface has to be a disk, which is laid out without a seam.
        """
        settings = chosen(
            objective=objective,
            bound=bound,
            solver=solver,
            features_strict=features_strict,
            tolerance=tolerance,
            features=feature_sources(features, align_boundary) or [],
        )
        with running(known(run_options, RunOptions)) as run:
            given = None if uv is None else self._given(uv, face_uv)
            made = self._native.optimize(given, to_json(settings), run)
        return SeamlessMap._of(self, made)

    @documented("check", "integer", "tolerance", "alignment_tolerance", "integer_tolerance", "features")
    def certify(
        self,
        uv: npt.ArrayLike,
        face_uv: npt.ArrayLike | None = None,
        *,
        integer: bool = False,
        tolerance: float | None = None,
        alignment_tolerance: float | None = None,
        integer_tolerance: float | None = None,
        features: Features = None,
        align_boundary: bool = False,
        **run_options: Unpack[RunOptions],
    ) -> Verdict:
        """Certifies a map of this surface, whatever program made it: no triangle is flipped or collapsed, every seam fits,
        every cone angle is a multiple of a quarter turn. Finds every violation.

        Without ``face_uv`` the UVs are one a vertex (n, 2), or one a corner: (m, 3, 2) or (3m, 2).
        """
        settings = chosen(
            integer=integer,
            tolerance=tolerance,
            alignment_tolerance=alignment_tolerance,
            integer_tolerance=integer_tolerance,
            features=feature_sources(features, align_boundary) or [],
        )
        with running(known(run_options, RunOptions)) as run:
            is_passed, report = self._native.certify(self._given(uv, face_uv), to_json(settings), run)
        return Verdict(is_passed, json.loads(report))

    @documented("measure", "tolerance")
    def measure(
        self,
        uv: npt.ArrayLike,
        face_uv: npt.ArrayLike | None = None,
        *,
        tolerance: float | None = None,
        **run_options: Unpack[RunOptions],
    ) -> Measurements:
        """Measures the distortion of any map of this surface; it may have flips and open seams."""
        settings = to_json(chosen(tolerance=tolerance))
        with running(known(run_options, RunOptions)) as run:
            return Measurements._of(*self._native.measure(self._given(uv, face_uv), settings, run))

    def field(
        self,
        uv: npt.ArrayLike | None = None,
        face_uv: npt.ArrayLike | None = None,
        *,
        tolerance: float | None = None,
        **run_options: Unpack[RunOptions],
    ) -> CrossField:
        """The cross field that the axes of a seamless map are on this surface; without UVs, those of ``parametrize``."""
        if uv is None:
            return self.parametrize(**run_options).field()
        settings = to_json(chosen(tolerance=tolerance))
        with running(known(run_options, RunOptions)) as run:
            return CrossField._of(self, self._native.field(self._given(uv, face_uv), settings, run))

    @documented("features", "features")
    def features(
        self, sources: Features | float = "auto", *, align_boundary: bool = False, **run_options: Unpack[RunOptions]
    ) -> FeatureCurves:
        """Finds features and the curves that they form. A number stands for edges at which the surface bends by so many
        degrees.
        """
        named = to_json(feature_sources(sources, align_boundary) or [])
        with running(known(run_options, RunOptions)) as run:
            return FeatureCurves._of(self, self._native.features(named, run))

    def _given(self, uv: npt.ArrayLike, face_uv: npt.ArrayLike | None) -> tuple[bytes, bytes]:
        return map_bytes(uv, face_uv, self.faces, len(self.vertices))

    def __reduce__(self) -> tuple[Any, ...]:
        # What a file says beside its triangles does not go along.
        return _of_triangles, (self.vertices, self.faces)

    def __repr__(self) -> str:
        return f"<Surface: {len(self.vertices)} vertices, {len(self.faces)} triangles>"


def _of_triangles(vertices: Floats, faces: Ints) -> Surface:
    return Surface(vertices, faces, weld="off")


@documented("map", *_SURFACE)
def read(path: str | os.PathLike[str], **options: Unpack[SurfaceOptions]) -> Surface:
    """Reads a surface: OBJ, OFF, PLY, STL or glTF, also compressed with gzip.

    Raises ``InputError`` if it cannot be read, or with every fault if it is no surface.
    """
    if not isinstance(path, (str, os.PathLike)):
        raise InputError(f"{path!r} is no path")
    return Surface(path, **options)
