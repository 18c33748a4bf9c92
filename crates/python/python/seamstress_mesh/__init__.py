"""Certified seamless maps, integer-grid maps and quad meshes of triangle meshes.

    import seamstress_mesh as sm

    surface = sm.read("spot.obj")                 # or sm.Surface(V, F)
    seamless = surface.parametrize()              # seamless.uv, .face_uv, .cones, .certificate, .report
    quads = surface.quad_mesh(2500)               # quads.vertices, .quads, .irregular, .source_face, .source_bary

Every map that is returned is certified: no triangle is flipped, every seam fits, every cone angle is a multiple of 90
degrees. Keywords are the flags of the ``seamstress`` command, and reports are its reports.
"""

from ._attributes import Attribute
from ._errors import InputError, NoCertifiedMap, SeamstressError, Stopped
from ._native import __version__
from ._results import CrossField, FeatureCurves, IntegerGridMap, Measurements, QuadMesh, SeamlessMap, Verdict
from ._surface import Surface, read

__all__ = [
    "Attribute",
    "CrossField",
    "FeatureCurves",
    "InputError",
    "IntegerGridMap",
    "Measurements",
    "NoCertifiedMap",
    "QuadMesh",
    "SeamlessMap",
    "SeamstressError",
    "Stopped",
    "Surface",
    "Verdict",
    "__version__",
    "read",
]
