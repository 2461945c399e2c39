"""Newton-Euler equations of a tree with 40 digits, in inertial axes about each centre of mass.

Shares no code or formula with the package: forces and torques follow from the definition, body by body,
`f = m c̈` and `n = I α + ω × I ω`.
"""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np

from onorbit_rs.tools.validation.trees import Array, Part, Tree

DIGITS = 40


def vector(x: Any) -> mp.matrix:
    return mp.matrix([mp.mpf(c) for c in x])


def cross(a: mp.matrix, b: mp.matrix) -> mp.matrix:
    return mp.matrix([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def dot(a: mp.matrix, b: mp.matrix) -> mp.mpf:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def about(axis: mp.matrix, angle: mp.mpf) -> mp.matrix:
    """Returns a rotation matrix by Rodrigues' formula."""
    k = mp.matrix([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return mp.eye(3) + mp.sin(angle) * k + (1 - mp.cos(angle)) * (k * k)


def from_rpy(rpy: tuple[float, float, float]) -> mp.matrix:
    roll, pitch, yaw = (mp.mpf(x) for x in rpy)
    x, y, z = (mp.matrix([int(i == j) for j in range(3)]) for i in range(3))
    return about(z, yaw) * about(y, pitch) * about(x, roll)


class ExactTree:
    """Inverse and forward dynamics of a tree of moving joints, base first; its numbers count as exact."""

    def __init__(self, tree: Tree) -> None:
        self.parts = tree.parts
        self.index = {part.name: k for k, part in enumerate(tree.parts)}
        self.nv = 5 + len(tree.parts)

    def inverse_dynamics(self, q: Array, v: Any, a: Any) -> mp.matrix:
        """Returns the generalized forces; inputs and base rows are those of `Model.inverse_dynamics`."""
        with mp.workdps(DIGITS):
            return self._inverse_dynamics(q, mp.matrix(list(v)), mp.matrix(list(a)))

    def _inverse_dynamics(self, q: Array, v: mp.matrix, a: mp.matrix) -> mp.matrix:
        # inertial axes that coincide with the base's axes: the dynamics do not depend on the pose
        rot, pos = [mp.eye(3)], [mp.zeros(3, 1)]
        w, vel = [v[3:6]], [v[0:3]]
        alpha, acc = [a[3:6]], [a[0:3] + cross(v[3:6], v[0:3])]  # of the origin: v̇ + ω × v
        axes: list[mp.matrix] = [mp.zeros(3, 1)]
        for k, part in enumerate(self.parts[1:], start=1):
            p = self.index[str(part.parent)]
            axis = vector(part.axis)
            axis /= mp.sqrt(dot(axis, axis))
            x, rate, push = mp.mpf(q[6 + k]), v[5 + k], a[5 + k]
            fixed, arm = rot[p] * from_rpy(part.rpy), rot[p] * vector(part.xyz)
            z = fixed * axis
            slides = part.kind == "prismatic"
            arm = arm + z * x if slides else arm
            rot.append(fixed if slides else fixed * about(axis, x))
            pos.append(pos[p] + arm)
            vel.append(vel[p] + cross(w[p], arm) + (z * rate if slides else 0 * z))
            swept = acc[p] + cross(alpha[p], arm) + cross(w[p], cross(w[p], arm))
            if slides:
                w.append(w[p])
                alpha.append(alpha[p])
                acc.append(swept + 2 * cross(w[p], z * rate) + z * push)
            else:
                w.append(w[p] + z * rate)
                alpha.append(alpha[p] + cross(w[p], z * rate) + z * push)
                acc.append(swept)
            axes.append(z)
        return self._collect(rot, pos, w, alpha, acc, axes, a)

    def _collect(
        self, rot: Any, pos: Any, w: Any, alpha: Any, acc: Any, axes: Any, a: mp.matrix
    ) -> mp.matrix:
        tau = mp.zeros(self.nv, 1)
        self.size = np.zeros(self.nv)
        force = [mp.zeros(3, 1) for _ in self.parts]
        moment = [mp.zeros(3, 1) for _ in self.parts]  # about the body's own origin
        for k in range(len(self.parts) - 1, -1, -1):
            part: Part = self.parts[k]
            c = rot[k] * vector(part.com)
            tensor = rot[k] * mp.matrix([[mp.mpf(x) for x in row] for row in part.inertia]) * rot[k].T
            f = mp.mpf(part.mass) * (acc[k] + cross(alpha[k], c) + cross(w[k], cross(w[k], c)))
            force[k] += f
            self._add_sizes(k, c + pos[k], pos, [tensor * alpha[k], cross(w[k], tensor * w[k])], f)
            moment[k] += tensor * alpha[k] + cross(w[k], tensor * w[k]) + cross(c, f)
            if k == 0:
                continue
            slides = part.kind == "prismatic"
            tau[5 + k] = (
                dot(axes[k], force[k] if slides else moment[k]) + mp.mpf(part.rotor_inertia) * a[5 + k]
            )
            p = self.index[str(part.parent)]
            force[p] += force[k]
            moment[p] += moment[k] + cross(pos[k] - pos[p], force[k])
        tau[0:3], tau[3:6] = force[0], moment[0]
        return tau

    def _add_sizes(
        self, k: int, com: mp.matrix, pos: Any, moments: list[mp.matrix], force: mp.matrix
    ) -> None:
        """Adds the contribution of body `k` to `size` by magnitude: `|f|` or `|n| + |lever| |f|`.

        Rounding the data of the body (an inertia, the direction of an axis) changes a row by about one unit
        in the last place of the sum of these contributions.
        """
        f, n = float(mp.norm(force)), sum(float(mp.norm(moment)) for moment in moments)
        j = k
        while j > 0:
            slides = self.parts[j].kind == "prismatic"
            self.size[5 + j] += f if slides else n + f * float(mp.norm(com - pos[j]))
            j = self.index[str(self.parts[j].parent)]
        self.size[0:3] += f
        self.size[3:6] += n + f * float(mp.norm(com))

    def system(self, q: Array, v: Any) -> tuple[mp.matrix, mp.matrix]:
        """Returns mass matrix and bias forces."""
        still, bias = [0] * self.nv, self.inverse_dynamics(q, v, [0] * self.nv)
        with mp.workdps(DIGITS):
            mass = mp.zeros(self.nv)
            for j in range(self.nv):
                unit = [int(i == j) for i in range(self.nv)]
                mass[:, j] = self.inverse_dynamics(q, still, unit)
        return mass, bias

    def forward_dynamics(self, q: Array, v: Any, tau: Any) -> mp.matrix:
        mass, bias = self.system(q, v)
        with mp.workdps(DIGITS):
            return mp.lu_solve(mass, vector(tau) - bias)


def as_floats(x: mp.matrix) -> Array:
    return np.array([float(c) for c in x])
