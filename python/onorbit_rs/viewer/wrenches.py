"""Forces on the bodies, their resultant, and the resultant torque about the centre of mass of the robot."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs._core import COLUMNS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.viewer.trace_rows import TraceRows

    Floats = NDArray[np.float64]


(_FORCE, _), (_TORQUE, _) = COLUMNS["wrenches"].parts.values()


def centers_of_bodies(rows: TraceRows, model: Model) -> Floats:
    """Return the centres of mass of the bodies in W: (T, bodies, 3), m."""
    q = np.ascontiguousarray(rows["q"])
    centers = np.empty((len(q), len(model.bodies), 3))
    for index, body in enumerate(model.bodies):
        pose = np.asarray(model.frame_pose(q, body.name))
        centers[:, index] = pose[:, :3, :3] @ np.array(body.com) + pose[:, :3, 3]
    return centers


def forces(wrenches: Floats) -> Floats:
    """Return the forces (T, bodies, 3), N, of wrenches (T, bodies, 6)."""
    found: Floats = wrenches[:, :, _FORCE]
    return found


def net_force(wrenches: Floats) -> Floats:
    """Return the sum (T, 3), N, of the forces of wrenches (T, bodies, 6)."""
    force: Floats = forces(wrenches).sum(axis=1)
    return force


def torque_about_center(rows: TraceRows, centers: Floats, wrenches: Floats) -> Floats:
    """Return `Σ (rₖ - r) × Fₖ + Tₖ` in W, (T, 3), N m: the torque about the robot's centre of mass `r`.

    Body `k` has its centre of mass at `rₖ`, where the force `Fₖ` and the torque `Tₖ` act.

    Parameters
    ----------
    rows : TraceRows
        Rows with the configurations of the robot.
    centers : (T, bodies, 3) array, m
        Centres of mass of the bodies in W, at which the forces act.
    wrenches : (T, bodies, 6) array, N and N m
        Force on each body and torque about its centre of mass, in axes of W.
    """
    lever = centers - rows["center_of_mass"][:, None, :]
    torque: Floats = (np.cross(lever, forces(wrenches)) + wrenches[:, :, _TORQUE]).sum(axis=1)
    return torque
