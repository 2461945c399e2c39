"""Tests captures and releases against closed forms and, for random robots, Gauss's principle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import BASE_NV, JOINTS_Q, JOINTS_V, QUATERNION
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.tools.validation.case import Case, Gate, worst
from onorbit_rs.tools.validation.gauss import Craft, impact, impact_at_stop
from onorbit_rs.tools.validation.trees import Array, Tree, build, random_state, random_tree

STEP = 1e-3  # s
SEEDS = range(12)


def rigid(name: str, mass: float, inertia: Sequence[float], q: Sequence[float], v: Any) -> oo.System:
    """Return a rigid spacecraft at ``q`` (3,), m, in W, with identity attitude and velocity ``v`` (6,)."""
    model = oo.Model.rigid_body(mass, np.diag(inertia))
    return oo.System(name, model, [*q, 0.0, 0.0, 0.0, 1.0], v)


def run(
    systems: Sequence[oo.System],
    events: Sequence[oo.Capture | oo.Release | oo.Engage | oo.Disengage],
    duration: float,
    *,
    orbit: oo.Orbit | None = None,
    **settings: Any,
) -> oo.WorldTrace:
    """Return the trace of a world with these systems and events."""
    trace = oo.Simulation(oo.World(systems, orbit=orbit, events=events), **settings).run(duration)
    assert isinstance(trace, oo.WorldTrace)
    return trace


def capture(first: Craft, second: Craft, **settings: Any) -> tuple[oo.EventRecord, Array, Array]:
    """Simulate a capture of the second craft at t = 0; return the record and both velocities afterwards."""
    systems = [
        oo.System(name, craft.model, craft.q, craft.v)
        for name, craft in zip("ab", (first, second), strict=True)
    ]
    event = oo.Capture("grasp", f"a/{first.frame}", f"b/{second.frame}", at=0.0)
    settings = {"time_step": STEP} | settings
    trace = run(systems, [event], settings["time_step"], **settings)
    (record,) = trace.events
    v_a, v_b = (trace[name].v[np.flatnonzero(trace[name].time == 0.0)[-1]] for name in "ab")
    return record, v_a, v_b


def momentum(craft: Craft, v: Array, point: Array) -> tuple[Array, Array]:
    """Return the momentum (6,) of a robot about a point in W, N s and N m s, and its scales (2,).

    The scales are the sums of the magnitudes of the linear and angular momenta of the links.
    """
    total, scales = np.zeros(6), np.zeros(2)
    for body in craft.model.bodies:
        pose = craft.model.frame_pose(craft.q, body.name)
        twist = craft.model.frame_velocity(craft.q, v, body.name)
        rot, arm = pose[:3, :3], pose[:3, :3] @ np.array(body.com)
        linear = body.mass * (twist[:3] + np.cross(twist[3:], arm))
        spin = rot @ np.array(body.inertia) @ rot.T @ twist[3:]
        angular = np.cross(pose[:3, 3] + arm - point, linear) + spin
        total += np.concatenate([linear, angular])
        scales += [np.linalg.norm(linear), np.linalg.norm(angular)]
    return total, scales


# two rigid craft, 2.5 m apart along x; all axes parallel
FIRST = (1000.0, [300.0, 400.0, 500.0])  # kg, kg m²
SECOND = (500.0, [120.0, 90.0, 150.0])
POSITION, VELOCITY = [2.5, 0.0, 0.0], [-0.05, 0.02, 0.01, 0.02, 0.05, -0.03]
LOST, RATE = 0.667209466941, [0.00571429, -0.00148964, 0.00445122]  # J, rad/s


def two_craft() -> tuple[float, ...]:
    """Return the errors after two rigid craft connect, as listed by the gates of the case.

    The errors are those of energy lost, J, common rate, rad/s, momentum at the capture (relative), momentum
    over the run, N s, and relative position, m.
    """
    first, second = rigid("a", *FIRST, [0, 0, 0], np.zeros(6)), rigid("b", *SECOND, POSITION, VELOCITY)
    event = oo.Capture("grasp", "a/base", "b/base", at=0.0)
    trace = run([first, second], [event], 100.0, time_step=0.01)
    (record,) = trace.events
    place = [matrix_from_quaternion(q[QUATERNION]).T @ (p[:3] - q[:3])
             for q, p in zip(trace["a"].q[::100], trace["b"].q[::100], strict=True)]  # fmt: skip
    rates = np.vstack([trace[name].v[1, 3:] for name in "ab"])
    change = np.abs(trace.momentum - trace.momentum[0]).max(axis=0)
    return (
        abs(record.energy_lost - LOST),
        float(np.abs(rates - RATE).max()),
        float(record.momentum_error.max()),
        float(change.max()),
        float(np.abs(np.array(place) - place[0]).max()),
    )


POINT_MASSES, CLOSING = (1000.0, 500.0), 0.05  # kg, m/s


def points() -> tuple[float, float]:
    """Return the errors of velocity change, m/s, and energy lost, J, of two point masses that stick."""
    first = rigid("a", POINT_MASSES[0], [1.0, 1.0, 1.0], [0, 0, 0], np.zeros(6))
    second = rigid("b", POINT_MASSES[1], [1.0, 1.0, 1.0], [1.0, 0, 0], [-CLOSING, 0, 0, 0, 0, 0])
    event = oo.Capture("grasp", "a/base", "b/base", at=0.5)
    trace = run([first, second], [event], 1.0, time_step=0.1)
    gained = -trace["a"].v[-1, 0]
    return abs(gained - 0.016666666666666666), abs(trace.events[0].energy_lost - 0.4166666666666667)


def random_craft(seed: int, tree: Tree | None = None) -> Craft:
    """Return a random robot in a random state with a random frame, which may be on any of its links."""
    rng = np.random.default_rng(7000 + seed)
    tree = tree or random_tree(seed, int(rng.integers(6, 17)))
    model = build(tree)
    state = random_state(model, rng, frames=1)
    return Craft(model, state.q, state.v, str(rng.choice(model.frame_names)))


def random_pair(seed: int) -> tuple[Craft, Craft]:
    """Return two random robots, of which the first captures the second."""
    return random_craft(seed), random_craft(1000 + seed)


def against_gauss(first: Craft, second: Craft, **settings: Any) -> tuple[float, ...]:
    """Return the errors of a capture against Gauss's principle, relative to each quantity's largest value.

    The quantities are velocity, energy lost, impulse, momentum and relative twist.
    """
    record, v_a, v_b = capture(first, second, **settings)
    expected, point = impact(first, second), first.pose[:3, 3]
    rates = np.abs(np.concatenate([first.v, second.v, *expected.v])).max()
    off = np.abs(np.concatenate([v_a, v_b]) - np.concatenate(expected.v)).max()
    at_point = record.impulse + np.append(np.zeros(3), np.cross(record.point - point, record.impulse[:3]))
    was = second.jacobian(point) @ second.v - first.jacobian(point) @ first.v
    left = second.jacobian(point) @ v_b - first.jacobian(point) @ v_a
    (a, of_a), (b, of_b) = momentum(first, first.v, point), momentum(second, second.v, point)
    (c, _), (d, _) = momentum(first, v_a, point), momentum(second, v_b, point)
    changes = np.linalg.norm((c + d - a - b).reshape(2, 3), axis=1) / (of_a + of_b)
    return (
        float(off / rates),
        abs(record.energy_lost / expected.energy_lost - 1.0),
        float(np.abs(at_point - expected.impulse).max() / np.abs(expected.impulse).max()),
        float(max(*changes, *record.momentum_error)),
        float(np.abs(left).max() / np.abs(was).max()),
    )


def random_trees() -> Any:
    """Return the largest errors of captures of random robots by random frames."""
    return worst(against_gauss(*random_pair(seed)) for seed in SEEDS)


def straight(count: int, *, tip: float = 2.0, rotor: float = 0.0, **joints: Any) -> oo.Model:
    """Return an arm along x on a base of 100 kg, with a frame `tip`; joint axes alternate between z and y."""
    builder = oo.ModelBuilder("arm", base="base", mass=100.0, com=[0, 0, 0], inertia=np.diag([20, 25, 30.0]))
    parent = "base"
    for i in range(count):
        mass = tip if i == count - 1 else 3.0
        builder.add_link(
            f"link{i}", parent=parent, joint=f"joint{i}", kind="revolute", axis=[0, i % 2, 1 - i % 2],
            xyz=[0.4, 0, 0], mass=mass, com=[0.2 if mass else 0.0, 0, 0],
            inertia=0.05 * np.eye(3) if mass else np.zeros((3, 3)), rotor_inertia=rotor, **joints,
        )  # fmt: skip
        parent = f"link{i}"
    builder.add_frame("tip", parent, xyz=[0.3, 0, 0])
    return builder.build()


def arm_and_target(model: oo.Model, joints: Any, rates: Any = 0.0) -> tuple[Craft, Craft]:
    """Return an arm with these joint positions and rates, and a random robot that the arm captures."""
    q, v = model.neutral(), np.zeros(model.nv)
    q[JOINTS_Q], v[:BASE_NV], v[JOINTS_V] = joints, [0.01, -0.02, 0.03, 0.05, -0.04, 0.02], rates
    return Craft(model, q, v, "tip"), random_craft(1001)


def singular() -> tuple[float, ...]:
    """Return the errors of a capture by a straight (singular) arm, whose tip cannot move along the arm."""
    return against_gauss(*arm_and_target(straight(5), 0.0, 0.1))


def massless() -> Any:
    """Return the largest errors of captures by and of a massless gripper with a rotor (Gauss's principle)."""
    first, second = arm_and_target(straight(5, tip=0.0, rotor=0.2), 0.3, 0.1)
    return worst([against_gauss(first, second), against_gauss(second, first)])


def at_stops() -> tuple[float, float]:
    """Return the relative errors of velocity and momentum for a capture that pushes a joint into its stop."""
    errors = []
    for restitution in (0.0, RESTITUTION):
        first, second = arm_and_target(straight(4, lower=-1.0, upper=0.5), [0.5, 0.2, -0.3, 0.1])
        systems = [
            oo.System("a", first.model, first.q, first.v, enforce_limits=True, restitution=restitution),
            oo.System("b", second.model, second.q, second.v),
        ]
        event = oo.Capture("grasp", "a/tip", f"b/{second.frame}", at=0.0)
        trace = run(systems, [event], STEP, time_step=STEP)
        after = np.concatenate([trace[name].v[np.flatnonzero(trace.time == 0.0)[-1]] for name in "ab"])
        expected = np.concatenate(impact_at_stop(first, second, 0, restitution))
        errors.append((
            np.abs(after - expected).max() / np.abs(expected).max(),
            np.abs(trace.momentum - trace.momentum[0]).max() / np.abs(trace.momentum[0]).max(),
        ))  # fmt: skip
    return worst(errors)  # type: ignore[no-any-return]


RESTITUTION = 0.5


def stuck() -> tuple[float, ...]:
    """Return the errors of a capture by an arm with sticking joints; bounded friction gives no impulse."""
    return against_gauss(*arm_and_target(straight(5, friction=STICKING), 0.3))


STICKING = 5.0  # N m
SPRING = [3.0, 0.0, 1.0, 0.0, 0.5, 0.0]  # N s and N m s, in the axes of the capturing frame at its origin


def spring() -> tuple[float, float, float, float]:
    """Return the errors of the changes of both velocities, of the energy gained and of momentum at a release.

    Two rigid craft of masses `m` and inertias `I` at rest: the impulse `J` and the angular impulse `L` at the
    point `r`, relative to each mass centre, give `Δv = ±J/m`, `Δω = ±I⁻¹ (L + r × J)`.
    """
    systems = [rigid("a", *FIRST, [0, 0, 0], np.zeros(6)), rigid("b", *SECOND, POSITION, np.zeros(6))]
    events: list[oo.Capture | oo.Release] = [
        oo.Capture("grasp", "a/base", "b/base", at=0.0),
        oo.Release("let_go", "grasp", at=0.5, impulse=PUSH),
    ]
    trace = run(systems, events, 1.0, time_step=0.1)
    force, moment = np.array(SPRING[:3]), np.array(SPRING[3:])
    row = np.flatnonzero(trace.time == 0.5)[-1]
    errors, energy = [], 0.0
    for name, sign, (mass, inertia), arm in (
        ("a", -1.0, FIRST, [0, 0, 0]), ("b", 1.0, SECOND, np.negative(POSITION)),
    ):  # fmt: skip
        rate = sign * (moment + np.cross(arm, force)) / inertia
        expected = np.concatenate([sign * force / mass, rate])
        energy += 0.5 * mass * np.sum(expected[:3] ** 2) + 0.5 * np.sum(inertia * rate**2)
        errors.append(np.abs(trace[name].v[row] - expected).max())
    record = trace.events[1]
    return (*errors, abs(record.energy_lost + energy), float(np.abs(trace.momentum).max()))


PUSH = list(SPRING)
ROUNDING = (
    Gate("velocity", 1e-12), Gate("energy lost", 1e-12), Gate("impulse", 1e-11),
    Gate("momentum", 1e-14), Gate("relative twist", 1e-12),
)  # fmt: skip
GAUSS = "Gauss's principle from two mass matrices"

CASES = (
    Case(
        "capture", "two rigid craft, then 100 s", "composite body, printed digits",
        (
            Gate("energy lost", 1e-12, "J"), Gate("rate", 6e-9, "rad/s"),
            Gate("momentum at the capture", 1e-15), Gate("momentum", 1e-12, "N s"),
            Gate("drift of the relative position", 1e-14, "m"),
        ), two_craft,
    ),
    Case(
        "capture", "two point masses stick", "reduced mass: ½ m1 m2/(m1 + m2) v²",
        (Gate("change of velocity", 1e-16, "m/s"), Gate("energy lost", 1e-15, "J")), points,
    ),
    Case("capture", "12 random pairs of trees", GAUSS, ROUNDING, random_trees),
    Case("capture", "a straight arm, which is singular", GAUSS, ROUNDING, singular),
    Case("capture", "a gripper without mass, both ways", GAUSS, ROUNDING, massless),
    Case("capture", "joints that stick", GAUSS, ROUNDING, stuck),
    Case(
        "capture", "a joint at its stop, restitution 0 and 0.5", GAUSS + " and the stop's row",
        (Gate("velocity", 1e-12), Gate("momentum", 1e-13)), at_stops,
    ),
    Case(
        "capture", "release with a spring", "Δv = J/m, Δω = I⁻¹ (L + r × J)",
        (
            Gate("velocity of the first", 1e-15), Gate("velocity of the second", 1e-15),
            Gate("energy gained", 1e-14, "J"), Gate("momentum", 1e-13, "N s"),
        ), spring,
    ),
)  # fmt: skip
