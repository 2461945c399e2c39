"""Reads mesh files into arrays, for the viewer and the figures.

Lengths are in m and in axes of the file: a Collada file's ``<unit>`` and the poses of nodes are applied.
Meshes are not rotated so that z points up. Collada's ``<up_axis>`` is ignored, as in RViz and Gazebo. glTF's
y-up convention, which Drake and recent versions of RViz apply, is also ignored, because robots on PyPI with
glTF meshes do not follow it.
"""

from onorbit_rs.visuals.meshes.part import Mesh, Part
from onorbit_rs.visuals.meshes.read import read_mesh

__all__ = ["Mesh", "Part", "read_mesh"]
