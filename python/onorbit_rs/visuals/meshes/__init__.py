"""Reads mesh files into arrays, for the viewer and the figures.

Lengths are in m and in the axes of the file: a Collada file's ``<unit>`` and the poses of nodes are applied.
Meshes are not turned to make z point up. Collada's ``<up_axis>`` is ignored, as by RViz and Gazebo. glTF's
y-up convention is ignored, too (Drake, and RViz since 2025, apply it), since the robots with glTF on PyPI are
made without it.
"""

from onorbit_rs.visuals.meshes.part import Mesh, Part
from onorbit_rs.visuals.meshes.read import read_mesh

__all__ = ["Mesh", "Part", "read_mesh"]
