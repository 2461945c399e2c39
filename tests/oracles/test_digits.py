"""Accuracy for small bodies far from the base, against Newton-Euler with 40 digits and beside Pinocchio.

Errors of inverse dynamics, and the residual of forward dynamics in the same equations, are relative to the
sum of the absolute moments in a row: rounding of the robot's data changes a row by about 1e-16 of this sum.
Worst of two states for each robot (seeds 0 and 1, printed with ``pytest -s``):

- backward error of inverse and forward dynamics: 3e-15; 4.3e-15 over 150 random trees
- a finger of 1 g and 1 mm on two booms of 100 m: 4e-16, Pinocchio 2e-11; accelerations 2e-10, Pinocchio 2e-5
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.tools.validation.trees import Array, Part, State, Tree, build, random_state

pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
mp = pytest.importorskip("mpmath", reason="the oracle is not installed: pip install mpmath")
import pin_robot  # noqa: E402
from exact_tree import DIGITS, ExactTree, as_floats  # noqa: E402

BACKWARD = 1e-14
HEAVY_ON_LIGHT = "sizes of all kinds, 2"  # 1e6 kg on 1 kg: Pinocchio's error is 4e-8
STATES = range(2)


def rod(name: str, mass: float, length: float, parent: str | None = None, **joint: Any) -> Part:
    """Returns a rod along z, attached at its lower end."""
    radius = length / 10
    across = mass * (length**2 + 3 * radius**2) / 12
    inertia = np.diag([across, across, mass * radius**2 / 2]).tolist()
    kind = "revolute" if parent else ""
    return Part(
        name, mass, [0.0, 0.0, length / 2], inertia, parent, f"joint_{name}" if parent else "", kind, **joint
    )


def fingers(reach: float, size: float, mass: float) -> Tree:
    """Returns two booms with a wrist and two fingers, one of which has two links."""
    tip = (0.0, 0.0, reach)
    return Tree(
        [
            rod("link0", 500.0, 2.0),
            rod("boom1", 10 * reach, reach, "link0", xyz=(0.0, 0.0, 1.0), axis=(0.0, 1.0, 0.0)),
            rod("boom2", 10 * reach, reach, "boom1", xyz=tip, axis=(1.0, 0.0, 0.3)),
            rod("wrist", 5.0, 0.3, "boom2", xyz=tip),
            rod("bone1", mass, size, "wrist", xyz=(0.01, 0.0, 0.3), axis=(0.0, 1.0, 0.0)),
            rod("bone2", mass, size, "bone1", xyz=(0.0, 0.0, size), axis=(0.0, 1.0, 0.0)),
            rod("thumb", mass, size, "wrist", xyz=(-0.01, 0.0, 0.3), axis=(0.0, 1.0, 0.0)),
        ],
        "bone2", (0.0, 0.0, size), (0.0, 0.0, 0.0),
    )  # fmt: skip


def sizes_of_all_kinds(seed: int, links: int = 9) -> Tree:
    """Returns a branched robot of bodies of 1 cm to 100 m of one density: masses of 1e-3 to 1e9 kg."""
    rng = np.random.default_rng(seed)
    size = 10 ** rng.uniform(-2, 2, links)

    def triple(scale: float) -> tuple[float, float, float]:
        x, y, z = rng.uniform(-scale, scale, 3).tolist()
        return (x, y, z)

    parts: list[Part] = []
    for i, s in enumerate(size):
        mass = float(1000 * s**3 * rng.uniform(0.1, 1))
        points = rng.normal(scale=0.3 * s, size=(6, 3))
        second = mass / 6 * (points - points.mean(axis=0)).T @ (points - points.mean(axis=0))
        inertia = np.trace(second) * np.eye(3) - second
        body = Part(f"link{i}", mass, list(triple(0.3 * s)), ((inertia + inertia.T) / 2).tolist())
        if i > 0:
            p = int(rng.integers(max(0, i - 3), i))
            kind = str(rng.choice(["revolute", "revolute", "prismatic"]))
            body = replace(
                body, parent=f"link{p}", joint=f"joint{i}", kind=kind, axis=triple(1.0),
                xyz=triple(float(size[p])), rpy=triple(3.0),
            )  # fmt: skip
        parts.append(body)
    return Tree(parts, f"link{links - 1}", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


FINGERS = {
    "10 g, 1 cm on 10 m": fingers(10.0, 0.01, 0.01),
    "1 g, 1 mm on 100 m": fingers(100.0, 0.001, 0.001),
}
ROBOTS = FINGERS | {
    f"sizes of all kinds, {seed}": sizes_of_all_kinds(seed) for seed in (*range(6), 32, 75, 148)
}


@dataclass(frozen=True)
class Errors:
    """Errors of inverse dynamics; residual and relative acceleration error of forward dynamics."""

    inverse: float
    backward: float
    forward: float


class Case:
    """A robot at one state, with the joints in the order of the tree."""

    def __init__(self, tree: Tree, seed: int) -> None:
        self.model, self.exact = build(tree), ExactTree(tree)
        self.pinocchio = pin_robot.PinRobot(pin_robot.build(tree), self.model.joint_names)
        self.state = replace(random_state(self.model, np.random.default_rng(seed)), external={})
        joints = [6 + self.model.joint_names.index(part.joint) for part in tree.parts[1:]]
        self.order = np.array([*range(6), *joints])
        s = self.state
        self.q = np.concatenate([s.q[:7], s.q[1 + self.order[6:]]])
        self.v, self.a = s.v[self.order], s.a[self.order]
        self.effort = self.exact.inverse_dynamics(self.q, self.v, self.a)
        self.size = self.exact.size
        tau = np.empty(self.model.nv)
        tau[self.order] = as_floats(self.effort)
        self.state = replace(s, tau=tau)
        self.tau = tau[self.order]
        self.acceleration = self.exact.forward_dynamics(self.q, self.v, self.tau)

    def errors(self, robot: Any) -> Errors:
        """Returns the errors of an engine with `inverse_dynamics(state)` and `forward_dynamics(state)`."""
        effort, acceleration = (
            robot.inverse_dynamics(self.state)[self.order],
            robot.forward_dynamics(self.state)[self.order],
        )
        open_rows = self.exact.inverse_dynamics(self.q, self.v, acceleration) - mp.matrix(self.tau.tolist())
        sizes = self.exact.size + np.abs(self.tau)
        largest = np.abs(as_floats(self.acceleration)).max()
        return Errors(
            inverse=float(np.max(np.abs(as_floats(mp.matrix(effort.tolist()) - self.effort)) / self.size)),
            backward=float(np.max(np.abs(as_floats(open_rows)) / sizes)),
            forward=float(
                np.max(np.abs(as_floats(mp.matrix(acceleration.tolist()) - self.acceleration))) / largest
            ),
        )


class Ours:
    """The package with one state, or with the same state in all lanes of a batch."""

    def __init__(self, model: oo.Model, rows: int | None = None) -> None:
        self.model, self.rows = model, rows

    def _of(self, kernel: Any, *inputs: Array) -> Array:
        if self.rows is None:
            return np.asarray(kernel(*inputs))
        results = kernel(*(np.tile(x, (self.rows, 1)) for x in inputs))
        assert np.ptp(results, axis=0).max() == 0.0
        return np.asarray(results[0])

    def inverse_dynamics(self, s: State) -> Array:
        return self._of(self.model.inverse_dynamics, s.q, s.v, s.a)

    def forward_dynamics(self, s: State) -> Array:
        return self._of(self.model.forward_dynamics, s.q, s.v, s.tau)


def worst(tree: Tree, rows: int | None = None) -> tuple[Errors, Errors]:
    """Returns the largest errors of the package and of Pinocchio over the states."""
    cases = [Case(tree, seed) for seed in STATES]
    ours = [case.errors(Ours(case.model, rows)) for case in cases]
    theirs = [case.errors(case.pinocchio) for case in cases]

    def largest(all_errors: list[Errors]) -> Errors:
        return Errors(
            *(max(getattr(e, name) for e in all_errors) for name in ("inverse", "backward", "forward"))
        )

    return largest(ours), largest(theirs)


@pytest.mark.parametrize("name", ROBOTS)
def test_small_bodies_far_from_the_base_keep_their_digits(name: str) -> None:
    ours, theirs = worst(ROBOTS[name])
    print(f"\n{name}: ours {ours}, Pinocchio {theirs}")
    assert max(ours.inverse, ours.backward) < BACKWARD
    assert ours.forward < 10 * theirs.forward


@pytest.mark.parametrize("name", [*FINGERS, HEAVY_ON_LIGHT])
def test_batches_of_small_bodies_keep_their_digits(name: str) -> None:
    ours, theirs = worst(ROBOTS[name], rows=9)
    assert max(ours.inverse, ours.backward) < BACKWARD
    assert ours.forward < 10 * theirs.forward


def test_the_inverse_mass_matrix_keeps_its_digits_with_heavy_bodies_on_light_ones() -> None:
    """``M M⁻¹ = 1`` with rows and columns in units of the square roots of ``M``'s diagonal."""
    case = Case(ROBOTS[HEAVY_ON_LIGHT], 0)
    s, unit = case.state, np.sqrt(np.diag(case.model.mass_matrix(case.state.q)))
    inverse = case.model.forward_dynamics_derivatives(s.q, s.v, s.tau)[2]
    product = (case.model.mass_matrix(s.q) @ inverse) * unit / unit[:, None]
    largest = np.abs(inverse * unit * unit[:, None]).max()  # effect of rounding the entries of M
    assert np.abs(product - np.eye(case.model.nv)).max() < BACKWARD * largest
    np.testing.assert_array_equal(inverse, case.model.forward_dynamics_derivatives(s.q, s.v, s.tau)[2])


def test_the_measure_detects_moments_taken_about_the_base() -> None:
    """Control: a moment about a point 200 m away in double precision, moved back, has a large error."""
    case = Case(FINGERS["1 g, 1 mm on 100 m"], 0)
    far = np.array([0.0, 0.0, 200.0])

    class AboutTheBase(Ours):
        def inverse_dynamics(self, s: State) -> Array:
            tau = super().inverse_dynamics(s).copy()
            thumb = 6 + self.model.joint_names.index("joint_thumb")
            force = 1e-3 * np.linalg.norm(far) * np.ones(3)
            tau[thumb] = (tau[thumb] + np.cross(far, force)[0]) - np.cross(far, force)[0]
            return tau

    assert case.errors(AboutTheBase(case.model)).inverse > 100 * BACKWARD


@pytest.mark.parametrize("name", FINGERS)
def test_derivatives_of_inverse_dynamics_keep_their_digits(name: str) -> None:
    """Central differences in 40 digits, exact to 1e-20, of the columns of the joints."""
    case = Case(FINGERS[name], 0)
    s, step = case.state, mp.mpf(10) ** -14
    ours_q, ours_v, _ = case.model.inverse_dynamics_derivatives(s.q, s.v, s.a)
    for j in range(6, case.model.nv):
        for ours, place in ((ours_q, 0), (ours_v, 1)):
            ends = []
            for sign in (1, -1):
                q, v = [mp.mpf(x) for x in case.q], [mp.mpf(x) for x in case.v]
                changed, i = ((q, j + 1), (v, j))[place]
                with mp.workdps(DIGITS):
                    changed[i] += sign * step
                ends.append(case.exact.inverse_dynamics(q, v, case.a))
            with mp.workdps(DIGITS):
                exact = as_floats((ends[0] - ends[1]) / (2 * step))
            column = ours[case.order, case.order[j]]
            # a column is a force per radian: relative to the row's moments, or to the column if larger
            sizes = np.maximum(case.size, np.abs(exact))
            assert np.max(np.abs(column - exact) / sizes) < BACKWARD, (name, j, place)
