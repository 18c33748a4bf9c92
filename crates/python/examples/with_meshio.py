"""Quads for simulation: written by meshio, with the triangle of the surface that each vertex comes from."""

import sys

import meshio

import seamstress_mesh as sm


def quads(mesh: meshio.Mesh, count: int) -> meshio.Mesh:
    """About so many quads of a mesh."""
    made = sm.Surface(mesh).quad_mesh(count)
    point_data = {"source_face": made.source_face, "source_bary": made.source_bary}
    return meshio.Mesh(made.vertices, [("quad", made.quads)], point_data=point_data)


if __name__ == "__main__":
    made = quads(meshio.read(sys.argv[1]), 800)
    made.write("quads.vtu")
    print(made)
