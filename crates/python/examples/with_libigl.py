"""A seamless map beside libigl's least-squares conformal map, on the upper half of a mesh."""

import sys

import igl
import numpy as np

import seamstress_mesh as sm


def upper_half(surface: sm.Surface) -> sm.Surface:
    """The largest piece of the triangles above the middle."""
    height = surface.vertices[surface.faces, 1].mean(1)
    faces = surface.faces[height > np.median(height)]
    piece = igl.facet_components(faces)
    piece = piece[1] if isinstance(piece, tuple) else piece
    faces = faces[piece == np.bincount(piece).argmax()]
    used, numbered = np.unique(faces, return_inverse=True)
    # Where it touches itself in a point, vertices are split.
    return sm.Surface(surface.vertices[used], numbered.reshape(-1, 3), repair=True)


def compare(surface: sm.Surface) -> dict[str, float]:
    """The mean symmetric Dirichlet energy of both maps; 4 is an isometry."""
    loop = igl.boundary_loop(surface.faces)
    pinned = np.array([loop[0], loop[len(loop) // 2]])
    conformal, _ = igl.lscm(surface.vertices, surface.faces, pinned, np.array([[0.0, 0.0], [1.0, 0.0]]))
    seamless = surface.parametrize()
    maps = {"libigl's LSCM": (conformal,), "seamless": (seamless.uv, seamless.face_uv)}
    return {name: surface.measure(*uvs)["symmetric-dirichlet"]["mean"] for name, uvs in maps.items()}


if __name__ == "__main__":
    for name, energy in compare(upper_half(sm.read(sys.argv[1]))).items():
        print(f"{name:<14} symmetric Dirichlet energy {energy:.4f}")
