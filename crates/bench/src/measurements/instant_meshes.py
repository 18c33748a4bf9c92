"""Quads by Instant Meshes, through its wheel: instant_meshes.py MESH.obj QUADS.obj COUNT"""
import sys

import numpy as np
import pynanoinstantmeshes

mesh, quads, count = sys.argv[1], sys.argv[2], int(float(sys.argv[3]))
lines = [line.split() for line in open(mesh)]
vertices = np.array([line[1:4] for line in lines if line[:1] == ["v"]], dtype=np.float32)
faces = np.array([[int(word.split("/")[0]) - 1 for word in line[1:4]] for line in lines if line[:1] == ["f"]], dtype=np.uint32)
# It splits every cell in four in the end, and counts the vertices before.
vertices, faces = pynanoinstantmeshes.remesh(vertices, faces, count // 4)
with open(quads, "w") as out:
    out.writelines("v %g %g %g\n" % tuple(v) for v in vertices)
    out.writelines("f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces)
