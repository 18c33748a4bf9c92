"""A mesh of trimesh in, one with the seamless map as its texture coordinates out."""

import sys

import trimesh

import seamstress_mesh as sm


def textured(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """The mesh, cut along the seams of a seamless map, with its UVs."""
    seamless = sm.Surface(mesh).parametrize()
    # A vertex of the result is a UV: the vertex of the mesh that it is of comes from any corner that has it.
    vertex = seamless.face_uv.copy().ravel()
    origin = vertex.copy()
    origin[vertex] = seamless.surface.faces.ravel()
    positions = seamless.surface.vertices[origin[: len(seamless.uv)]]
    visual = trimesh.visual.TextureVisuals(uv=seamless.uv)
    return trimesh.Trimesh(positions, seamless.face_uv, visual=visual, process=False)


if __name__ == "__main__":
    made = textured(trimesh.load(sys.argv[1], force="mesh", process=False))
    made.export("textured.glb")
    print(made)
