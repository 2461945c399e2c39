"""One tree of two robots against two trees with the six rows of a weld.

Pinocchio's `constraintDynamics` and `lcaba` connect two free robots by a `CONTACT_6D`. This package attaches
one robot to the other, merges both at a capture, or welds the ends of six joints between them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from attached_pairs import PREFIX, Pair, add_parts, pair

import onorbit_rs as oo
from onorbit_rs.tools.validation.trees import BASE, Array, deviation

pin = pytest.importorskip("pinocchio", reason="the oracle is not installed: pip install pin")
import pin_robot  # noqa: E402
from pin_loops import solve  # noqa: E402
from test_world_pinocchio import captured  # noqa: E402

SEEDS = range(6)
GATE = 1e-10
METHODS = ("constraintDynamics", "lcaba")
MU = 1e-3  # `lcaba` is less accurate with a smaller one
STEP, STEPS = 1e-3, 20


class TwoTrees:
    """Both robots in Pinocchio, each with its own free base, and a weld of A's tool to the `grasp` of B."""

    def __init__(self, two: Pair, grasp: str = "tool") -> None:
        self.model = pin.Model()
        self.model.gravity.linear = np.zeros(3)
        self.weld, sides, self.q_of, self.v_of = pin.StdVec_RigidConstraintModel(), [], [], []
        for prefix, tree, part in (("", two.tree_a, two.a), (PREFIX, two.tree_b, two.b)):
            pin_robot.add_tree(self.model, tree, prefix)
            joints = [self.model.joints[self.model.getJointId(name)] for name in part.joint_names]
            base = self.model.joints[self.model.getJointId(f"{prefix}root")]
            self.q_of.append(np.array([*range(base.idx_q, base.idx_q + 7), *(j.idx_q for j in joints)]))
            self.v_of.append(np.array([*range(base.idx_v, base.idx_v + 6), *(j.idx_v for j in joints)]))
            frame = self.model.frames[self.model.getFrameId(prefix + (grasp if prefix else "tool"))]
            sides += [frame.parentJoint, frame.placement * pin.SE3(np.eye(4) if prefix else two.pose)]
        kind, axes = pin.ContactType.CONTACT_6D, pin.ReferenceFrame.LOCAL
        self.weld.append(pin.RigidConstraintModel(kind, self.model, *sides, axes))

    def vector(self, parts: Any, places: list[Array]) -> Array:
        out = np.zeros(sum(map(len, places)))
        for part, place in zip(parts, places, strict=True):
            out[place] = part
        return out

    def accelerations(self, method: str, q: Any, v: Any, tau: Any) -> list[Array]:
        """Returns the accelerations of both robots in the layouts of this package."""
        v, tau = (self.vector(parts, self.v_of) for parts in (v, tau))
        a, _ = solve(method, self.model, self.weld, self.vector(q, self.q_of), v, tau, MU)
        return [a[place] for place in self.v_of]


@pytest.fixture(scope="module", params=SEEDS)
def two(request: pytest.FixtureRequest) -> Pair:
    return pair(request.param)


def random_efforts(two: Pair) -> tuple[Array, list[Array]]:
    """Returns efforts on the merged tree, and the same on both robots, without a wrench on the base of B."""
    both = np.random.default_rng(9000).uniform(-2.0, 2.0, two.both.nv)
    return both, [
        np.r_[both[:6], of_joints(two, two.a, both)],
        np.r_[np.zeros(6), of_joints(two, two.b, both)],
    ]


def of_joints(two: Pair, part: oo.Model, x: Array) -> Array:
    """Returns the entries of `x`, (nv,) of the merged tree, that belong to the joints of a part."""
    return x[6:][[two.both.joint_names.index(name) for name in part.joint_names]]


def test_the_merged_tree_against_two_trees_with_six_rows(two: Pair) -> None:
    both, parts = random_efforts(two)
    ours = two.both.forward_dynamics(*two.state, both)
    found = np.r_[ours[:6], of_joints(two, two.a, ours), of_joints(two, two.b, ours)]
    q, v = zip(two.state_a, two.state_b, strict=True)
    for method in METHODS:
        a, b = TwoTrees(two).accelerations(method, q, v, parts)
        assert deviation(found, np.r_[a, b[6:]]) < GATE, method
        # negative control: another link of B is grasped
        other = next(part.name for part in two.tree_b.parts if part.name != two.tree_b.tool_link)
        a, b = TwoTrees(two, other).accelerations(method, q, v, parts)
        assert deviation(found, np.r_[a, b[6:]]) > 1e-3, method


def with_free_joints(two: Pair) -> oo.Model:
    """Returns a tree of both robots in which six joints connect the base of B to the base of A."""
    base_a, base_b = (tree.parts[0] for tree in (two.tree_a, two.tree_b))
    builder = oo.ModelBuilder(
        "both", base=base_a.name, mass=base_a.mass, com=base_a.com, inertia=base_a.inertia
    )
    links = [BASE, *(f"carrier{i}" for i in range(5)), PREFIX + BASE]
    inertial: dict[str, Any] = {"mass": base_b.mass, "com": base_b.com, "inertia": base_b.inertia}
    add_parts(builder, two.tree_a, "")
    for i in range(6):
        builder.add_link(
            links[i + 1], parent=links[i], joint=f"free{i}", kind="prismatic" if i < 3 else "revolute",
            axis=np.eye(3)[i % 3], **(inertial if i == 5 else {}),
        )  # fmt: skip
    add_parts(builder, two.tree_b, PREFIX)
    return builder.build()


def test_the_merged_tree_against_a_loop_of_six_joints(two: Pair) -> None:
    tree, rng = with_free_joints(two), np.random.default_rng(9100)
    q = tree.integrate(tree.neutral(), rng.uniform(-1.0, 1.0, tree.nv))
    tool, grasp = (tree.frame_pose(q, name) for name in ("tool", f"{PREFIX}tool"))
    pose = np.linalg.solve(tool, grasp)
    model = tree.with_loops([oo.Loop("weld", "weld", "tool", f"{PREFIX}tool", pose_a=pose)])
    v, tau = model.closed_velocity(q, rng.uniform(-1.0, 1.0, tree.nv)), rng.uniform(-2.0, 2.0, tree.nv)
    tau[[6 + tree.joint_names.index(f"free{i}") for i in range(6)]] = 0.0
    merged = oo.attach(two.a, "tool", two.b, f"{PREFIX}tool", pose=pose)
    common = [tree.joint_names.index(name) for name in merged.joint_names]

    def reduced(x: Array, base: int) -> Array:
        return np.r_[x[:base], x[base:][common]]

    expected = merged.forward_dynamics(reduced(q, 7), reduced(v, 6), reduced(tau, 6))
    a, _ = model.constrained_forward_dynamics(q, v, tau)
    assert deviation(reduced(a, 6), expected) < GATE
    assert deviation(reduced(tree.forward_dynamics(q, v, tau), 6), expected) > 1e-3  # negative control


def configuration_rate(q: Array, v: Array) -> Array:
    """Returns q̇, with the derivative of the unit quaternion `½ q ⊗ ω`."""
    quaternion = pin.Quaternion(*np.roll(q[3:7], 1))
    turn = (quaternion * pin.Quaternion(0.0, *v[3:6])).coeffs()
    return np.r_[quaternion.matrix() @ v[:3], 0.5 * turn, v[6:]]


def integrate(two: Pair, states: list[Array], steps: int, *, is_welded: bool = True) -> list[Array]:
    """Returns the states (q and v in one array) of both robots after steps of RK4."""
    parts, trees = (two.a, two.b), TwoTrees(two)

    def rates(states: list[Array]) -> list[Array]:
        q, v = ([np.split(x, [part.nq])[i] for x, part in zip(states, parts, strict=True)] for i in (0, 1))
        tau = [np.zeros(part.nv) for part in parts]
        if is_welded:
            a = trees.accelerations(METHODS[0], q, v, tau)
        else:
            a = [part.forward_dynamics(*x) for part, *x in zip(parts, q, v, tau, strict=True)]
        return [np.r_[configuration_rate(*x), a] for *x, a in zip(q, v, a, strict=True)]

    def moved(by: float, rate: list[Array]) -> list[Array]:
        return [x + by * dx for x, dx in zip(states, rate, strict=True)]

    for _ in range(steps):
        k1 = rates(states)
        k2 = rates(moved(STEP / 2.0, k1))
        k3 = rates(moved(STEP / 2.0, k2))
        k4 = rates(moved(STEP, k3))
        mean = [(a + 2.0 * b + 2.0 * c + d) / 6.0 for a, b, c, d in zip(k1, k2, k3, k4, strict=True)]
        states = moved(STEP, mean)
    return states


def test_a_captured_robot_moves_as_two_trees_with_six_rows(two: Pair) -> None:
    trace, _ = captured(two, STEPS * STEP, time_step=STEP)
    start, end = (
        [np.r_[trace[name].q[row], trace[name].v[row]] for name in "ab"]
        for row in (np.flatnonzero(trace.time == 0.0)[-1], -1)
    )
    change = np.concatenate(end) - np.concatenate(start)
    expected = np.concatenate(integrate(two, start, STEPS)) - np.concatenate(start)
    assert deviation(change, expected) < GATE
    free = np.concatenate(integrate(two, start, STEPS, is_welded=False)) - np.concatenate(start)
    assert deviation(change, free) > 1e-3  # negative control
