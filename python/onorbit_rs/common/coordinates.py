"""Indices into configurations and velocities, and into the corresponding forces and matrices."""

from __future__ import annotations

from onorbit_rs._core import COLUMNS

(POSITION, _), (QUATERNION, _), (JOINTS_Q, _) = COLUMNS["q"].parts.values()
(LINEAR, _), (ANGULAR, _), (JOINTS_V, _) = COLUMNS["v"].parts.values()

BASE_NQ: int = JOINTS_Q.start
"""Number of coordinates of the base: joint ``j`` has the position ``q[BASE_NQ + j]``."""

BASE_NV: int = JOINTS_V.start
"""Number of velocities of the base: joint ``j`` has the rate ``v[BASE_NV + j]``."""

BASE_Q, BASE_V = slice(BASE_NQ), slice(BASE_NV)
