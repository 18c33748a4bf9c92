"""Pictures by pyvista: a seamless map as texture, and quads with their irregular vertices."""

import sys

import numpy as np
import pyvista as pv

import seamstress_mesh as sm


def textured(seamless: sm.SeamlessMap) -> pv.PolyData:
    """The surface with a corner each, so that seams are sharp."""
    corners = seamless.surface.vertices[seamless.surface.faces].reshape(-1, 3)
    mesh = pv.PolyData.from_regular_faces(corners, np.arange(len(corners)).reshape(-1, 3))
    mesh.active_texture_coordinates = seamless.corner_uv
    return mesh


def quads(made: sm.QuadMesh) -> tuple[pv.PolyData, pv.PolyData]:
    """The quads, and their irregular vertices with their indices."""
    irregular = pv.PolyData(made.vertices[made.irregular[:, 0]])
    irregular["index"] = made.irregular[:, 1]
    return pv.PolyData.from_regular_faces(made.vertices, made.quads), irregular


if __name__ == "__main__":
    surface = sm.read(sys.argv[1])
    checks = np.kron(np.indices((8, 8)).sum(0) % 2, np.ones((16, 16)))[..., None] * [255, 255, 255]
    plotter = pv.Plotter(shape=(1, 2), off_screen=True)
    plotter.add_mesh(textured(surface.parametrize()), texture=pv.numpy_to_texture(checks.astype(np.uint8)))
    plotter.subplot(0, 1)
    mesh, irregular = quads(surface.quad_mesh(1000))
    plotter.add_mesh(mesh, show_edges=True)
    plotter.add_mesh(irregular, scalars="index", point_size=10, render_points_as_spheres=True)
    plotter.link_views()
    plotter.screenshot("pictures.png")
    print("pictures.png")
