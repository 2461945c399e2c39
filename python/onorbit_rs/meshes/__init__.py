"""Mesh files as arrays, for viewer and figures alike.

Lengths are in m and in the axes of the file: a Collada file's ``<unit>`` and the poses of nodes are applied.
Which axis is up is not asked, neither of Collada (``<up_axis>``, which RViz and Gazebo pass over, too) nor of
glTF (which Drake, and RViz since 2025, turn from y up to z up; robots with glTF on PyPI are made as if not).
"""

from onorbit_rs.meshes.part import Mesh, Part
from onorbit_rs.meshes.read import read_mesh

__all__ = ["Mesh", "Part", "read_mesh"]
