"""Robots of one link with a given collision geometry, and mesh files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

import onorbit_rs as oo

INERTIAL = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"

CUBE = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
CUBE_FACES = [
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
    (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
]  # fmt: skip


def element(geometry: str, xyz: ArrayLike = (0, 0, 0)) -> str:
    place = " ".join(map(str, np.asarray(xyz)))
    return f"<collision><origin xyz='{place}'/><geometry>{geometry}</geometry></collision>"


def body(*collisions: str, name: str = "body") -> oo.Model:
    """Return a rigid body with these collision elements."""
    return oo.Model.from_urdf_string(
        f"<robot name='{name}'><link name='{name}'>{INERTIAL}{''.join(collisions)}</link></robot>"
    )


def world_of(a: oo.Model, b: oo.Model) -> oo.World:
    """Return a world of two rigid bodies, ``a/body`` and ``b/body``."""
    far = b.neutral()
    far[0] = 100.0
    return oo.World([oo.System("a", a, a.neutral(), np.zeros(6)), oo.System("b", b, far, np.zeros(6))])


def obj_file(path: Path, vertices: ArrayLike, faces: list[tuple[int, int, int]]) -> Path:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(vertices).tolist()]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return path


def binary_stl(path: Path, vertices: ArrayLike, faces: list[tuple[int, int, int]]) -> Path:
    corners = np.asarray(vertices, dtype="<f4")[np.array(faces)]
    rows = np.zeros(
        len(faces), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]
    )
    rows["corners"] = corners
    path.write_bytes(b"\0" * 80 + np.uint32(len(faces)).tobytes() + rows.tobytes())
    return path


def random_pose(rng: np.random.Generator, apart: float) -> NDArray[np.float64]:
    """Return a random configuration ``[p, quat_xyzw]``; each component of p is within ``apart``, m."""
    turn = rng.normal(size=4)
    return np.concatenate([rng.uniform(-apart, apart, 3), turn / np.linalg.norm(turn)])
