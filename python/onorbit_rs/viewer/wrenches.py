"""What acts on the robot: where on each body, and about the centre of mass of the whole."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.viewer.rows import Rows

    Floats = NDArray[np.float64]


def centers_of_bodies(rows: Rows, model: Model) -> Floats:
    """(T, bodies, 3) centres of mass, W, m."""
    q = np.ascontiguousarray(rows["q"])
    centers = np.empty((len(q), len(model.bodies), 3))
    for index, body in enumerate(model.bodies):
        pose = np.asarray(model.frame_pose(q, body.name))
        centers[:, index] = pose[:, :3, :3] @ np.array(body.com) + pose[:, :3, 3]
    return centers


def torque_about_center(rows: Rows, centers: Floats, wrenches: Floats) -> Floats:
    """(T, 3) torque about the centre of mass `r` of the whole, W, N m: `Σ (rₖ - r) × Fₖ + Tₖ`.

    ``wrenches`` (T, bodies, 6) act at ``centers`` (T, bodies, 3).
    """
    lever = centers - rows["center_of_mass"][:, None, :]
    torque: Floats = (np.cross(lever, wrenches[:, :, :3]) + wrenches[:, :, 3:]).sum(axis=1)
    return torque
