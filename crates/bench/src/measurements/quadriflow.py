"""Quads by QuadriFlow, through its wheel: quadriflow.py MESH.obj QUADS.obj COUNT"""
import sys

from pyQuadriFlow.pyQuadriFlow import pyquadriflow

mesh, quads, count = sys.argv[1], sys.argv[2], int(float(sys.argv[3]))
lines = [line.split() for line in open(mesh)]
vertices = [[float(x) for x in line[1:4]] for line in lines if line[:1] == ["v"]]
faces = [[int(word.split("/")[0]) - 1 for word in line[1:4]] for line in lines if line[:1] == ["f"]]
# With its own defaults: a seed of 0, and no option.
made = pyquadriflow(count, 0, vertices, faces, False, False, False, False, False)
with open(quads, "w") as out:
    out.writelines("v %.9g %.9g %.9g\n" % tuple(v) for v in made["vertices"])
    out.writelines("f " + " ".join(str(v + 1) for v in face) + "\n" for face in made["faces"])
