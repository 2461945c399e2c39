"""Meshes of prisms with a non-convex section, as unions of the cells of a grid."""

from __future__ import annotations

from pathlib import Path

from collision_robots import obj_file

Cell = tuple[int, int]
U = {(0, 0), (1, 0), (2, 0), (0, 1), (2, 1)}
"""Floor and two walls."""
L = {(0, 0), (1, 0), (2, 0), (0, 1)}
"""Floor and one wall."""
BRICK = {(i, k) for i in range(3) for k in range(2)}
X, Y, Z = (-0.5, -0.3, 0.3, 0.5), (-0.25, 0.25), (0.0, 0.2, 0.8)
"""Planes of the grid, m. The notch of the U is between x of -0.3 and 0.3, above z of 0.2."""


def prism(path: Path, cells: set[Cell], *, drop: int = 0, is_reversed: bool = False) -> Path:
    """Write the surface of the union of cells (i, k), without its first ``drop`` triangles."""
    vertices: list[tuple[float, float, float]] = []
    faces: list[tuple[int, int, int]] = []

    def add(*corners: tuple[float, float, float]) -> None:
        for corner in corners:
            if corner not in vertices:
                vertices.append(corner)
        a, b, c, d = (vertices.index(corner) for corner in corners)
        faces.extend([(a, b, c), (a, c, d)])

    for i, k in sorted(cells):
        (x0, x1), (y0, y1), (z0, z1) = X[i : i + 2], Y, Z[k : k + 2]
        add((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1))
        add((x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0))
        if (i - 1, k) not in cells:
            add((x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0))
        if (i + 1, k) not in cells:
            add((x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1))
        if (i, k - 1) not in cells:
            add((x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0))
        if (i, k + 1) not in cells:
            add((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1))
    kept = [face[::-1] if is_reversed else face for face in faces[drop:]]
    return obj_file(path, vertices, kept)
