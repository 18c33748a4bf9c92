"""Data sets: one command over many meshes, each in a process of its own.

    python -m seamstress_mesh.batch MESHES... -o FOLDER --task quad -- --quads 2000

A crash, a hang or a hog of memory costs its own row only. Everything stands in one manifest, ``manifest.sqlite``, which is
written by this process alone; what is in it is not done again. Engines run the tasks: ``local`` on this machine, or
``ray`` on a cluster.
"""
