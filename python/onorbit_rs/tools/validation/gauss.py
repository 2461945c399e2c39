"""Computes velocities after captures by Gauss's principle, densely, from the mass matrices of single robots.

The module does not combine robots into one tree: the six components of the relative twist at a common point
are constraints on the velocities of the separate trees.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import BASE_NV
from onorbit_rs.tools.validation.trees import Array


@dataclass(frozen=True)
class Craft:
    """A robot with its configuration and velocity, and the frame by which it captures or is captured."""

    model: oo.Model
    q: Array
    v: Array
    frame: str

    @property
    def pose(self) -> Array:
        """Pose of the frame in W, (4, 4)."""
        return np.asarray(self.model.frame_pose(self.q, self.frame))

    def jacobian(self, point: Array) -> Array:
        """Return the Jacobian (6, nv) of the frame's link at a point of W, in W axes."""
        jacobian = np.array(self.model.frame_jacobian(self.q, self.frame))
        jacobian[:3] += np.cross(jacobian[3:].T, point - self.pose[:3, 3]).T
        return jacobian


@dataclass(frozen=True)
class Impact:
    """Velocities (nv,) of both robots after a capture, impulse on the second robot, and energy lost.

    The impulse (6,) is in N s, then N m s about the origin of the capturing frame, in W axes.
    """

    v: tuple[Array, Array]
    impulse: Array
    energy_lost: float


def mass_matrix(crafts: Sequence[Craft]) -> Array:
    """Return the block-diagonal mass matrix (Σnv, Σnv) of several robots."""
    count = sum(craft.model.nv for craft in crafts)
    whole, at = np.zeros((count, count)), 0
    for craft in crafts:
        block = slice(at, at := at + craft.model.nv)
        whole[block, block] = craft.model.mass_matrix(craft.q)
    return whole


def relative_twist(crafts: Sequence[Craft], first: int, second: int, gap: Array | float = 0.0) -> Array:
    """Return the Jacobian (6, nv) of the twist of the frame of `second` relative to the frame of `first`.

    The twists are those at the origin of the first frame; `gap`, (3,), m, shifts this point for the first
    robot.
    """
    point = crafts[first].pose[:3, 3]
    blocks = [np.zeros((6, craft.model.nv)) for craft in crafts]
    blocks[first] = -crafts[first].jacobian(point + gap)
    blocks[second] = crafts[second].jacobian(point)
    return np.hstack(blocks)


def project(
    mass: Array, rows: Array, v: Array, target: Array | float = 0.0, lines: Array | None = None
) -> tuple[Array, Array]:
    """Return the velocity closest to `v` in the metric of `mass` with `rows @ v == target`, and the impulses.

    The impulses act along `lines`, by default the rows. Scaling to a unit diagonal and one step of
    refinement keep the error at rounding.
    """
    lines = rows if lines is None else lines
    scale = 1.0 / np.sqrt(np.diag(mass))
    scaled, side = mass * np.outer(scale, scale), scale[:, None] * lines.T
    x = np.linalg.solve(scaled, side)
    x += np.linalg.solve(scaled, side - scaled @ x)
    response = scale[:, None] * x
    effect, total = rows @ response, np.zeros(len(rows))
    for _ in range(2):
        impulse = np.linalg.solve(effect, target - rows @ v)
        v, total = v + response @ impulse, total + impulse
    return v, total


def impact(first: Craft, second: Craft, *, gap: Array | float = 0.0, joints: bool = True) -> Impact:
    """Return the impact of a capture: the closest velocities without relative twist in the metric of `M`.

    With the mass matrix `M` of both robots, the Jacobian `J` of the relative twist and the velocities `v⁻`
    before the capture: `v⁺ = v⁻ − M⁻¹ Jᵀ Λ J v⁻`, `Λ = (J M⁻¹ Jᵀ)⁻¹`, energy lost `½ (J v⁻)ᵀ Λ (J v⁻)`,
    impulse on the second robot `−Λ J v⁻`. Two options give wrong results for negative controls: with a `gap`,
    the impulse on the first robot acts at another point; without `joints`, the impulse changes the velocities
    of the bases only.
    """
    crafts = (first, second)
    before, rows = np.concatenate([first.v, second.v]), relative_twist(crafts, 0, 1)
    lines = relative_twist(crafts, 0, 1, gap)
    if not joints:
        bases = [*range(BASE_NV), *range(first.model.nv, first.model.nv + BASE_NV)]
        lines[:, np.setdiff1d(np.arange(len(before)), bases)] = 0.0
    after, impulse = project(mass_matrix(crafts), rows, before, lines=lines)
    v_a, v_b = np.split(after, [first.model.nv])
    return Impact((v_a, v_b), impulse, float(-0.5 * (rows @ before) @ impulse))


def impact_at_stop(first: Craft, second: Craft, joint: int, restitution: float) -> tuple[Array, Array]:
    """Return both robots' velocities (nv,) after a capture that pushes a joint of the first into its stop.

    The stop replaces the joint rate `q̇` after the capture by `−e q̇`, with the restitution `e`, while the
    robots stay connected.
    """
    crafts = (first, second)
    after = np.concatenate(impact(first, second).v)
    row = np.zeros((1, len(after)))
    row[0, BASE_NV + joint] = 1.0
    rows = np.vstack([relative_twist(crafts, 0, 1), row])
    target = np.append(np.zeros(6), -restitution * after[BASE_NV + joint])
    v_a, v_b = np.split(project(mass_matrix(crafts), rows, after, target)[0], [first.model.nv])
    return v_a, v_b
