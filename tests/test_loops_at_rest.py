"""Joints of closed loops that friction, a stop or a brake brings to rest, and singular configurations."""

from __future__ import annotations

import time
import warnings
from typing import Any

import numpy as np
import pytest
from looped_robots import at_x, closing, linkage, rod, start

import onorbit_rs as oo
from onorbit_rs.tools.validation.linkages import LENGTHS, PIVOT, add_rod, at, base, four_bar_linkage

RATE = 2.0  # rad/s, of the crank


def four_bar(**crank: Any) -> oo.Model:
    """Returns the four-bar linkage of validation, with further properties of the crank's joint."""
    a, b, c, d = LENGTHS
    across = 0.5 * a**2 / 12.0
    builder = base("four_bar")
    builder.add_link(
        "crank", parent="base", joint="crank_joint", xyz=[PIVOT.real, PIVOT.imag, 0.0], mass=0.5,
        com=[a / 2.0, 0.0, 0.0], inertia=np.diag([0.01 * across, across, across]), **crank,
    )  # fmt: skip
    add_rod(builder, "coupler", "crank", a, 0.8, b)
    add_rod(builder, "rocker", "base", PIVOT + d, 0.6, c)
    builder.close(oo.Loop("pin", "revolute", "coupler", "rocker", pose_a=at(b), pose_b=at(c)))
    return builder.build()


LIMITS: Any = {"lower": 0.0, "upper": 2.0, "effort": 1.0, "velocity": 10.0}


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince"])
def test_friction_stops_a_linkage(integrator: Any) -> None:
    linkage = four_bar_linkage()
    q, v = linkage.state(1.0, RATE)
    energy = 0.5 * linkage.reduced(1.0).inertia * RATE**2
    begun = time.process_time()
    trace = oo.Simulation(four_bar(friction=0.05), q, v, time_step=1e-3, integrator=integrator).run(3.0)
    # the energy is the work of friction: E = T Δθ
    assert trace.q[-1, 7] - 1.0 == pytest.approx(energy / 0.05, abs=1e-9)
    at_rest = trace.v[trace.time > 1.2]
    assert np.all(at_rest[:, 6] == 0.0) and np.abs(at_rest).max() < 1e-14
    assert trace.dissipated[-1] == pytest.approx(energy, abs=1e-11)
    assert all(line[-1] for line in trace.certificate())
    assert time.process_time() - begun < 30.0  # with a rate of 1e-17 after the stop, it took minutes


def test_a_stop_without_restitution_stops_a_linkage() -> None:
    linkage = four_bar_linkage()
    q, v = linkage.state(1.0, RATE)
    trace = oo.Simulation(four_bar(**LIMITS), q, v, time_step=1e-3, enforce_limits=True).run(3.0)
    assert trace.q[-1, 7] == 2.0
    assert np.abs(trace.v[-1]).max() < 1e-14
    assert trace.dissipated[-1] == pytest.approx(0.5 * linkage.reduced(1.0).inertia * RATE**2, abs=1e-11)
    assert all(line[-1] for line in trace.certificate())


def test_a_linkage_rebounds_and_a_brake_stops_it() -> None:
    linkage = four_bar_linkage()
    q, v = linkage.state(1.0, RATE)
    brake = oo.Brake("brake", "crank_joint", slip_torque=0.01, engaged=True)
    settings: Any = {"time_step": 1e-3, "enforce_limits": True, "restitution": 0.5}
    trace = oo.Simulation(four_bar(**LIMITS), q, v, actuators=[brake], **settings).run(3.0)
    assert trace.q[:, 7].max() <= 2.0 + 1e-12
    assert trace.v[:, 6].min() < -0.1  # it rebounds
    assert np.all(trace.v[-100:, 6] == 0.0)
    assert trace.dissipated[-1] == pytest.approx(0.5 * linkage.reduced(1.0).inertia * RATE**2, abs=1e-11)
    assert all(line[-1] for line in trace.certificate())


def parallelogram() -> oo.Model:
    """Returns a parallelogram, all links of which can be on one line."""
    builder = oo.ModelBuilder("parallelogram", base="base", mass=4.0, inertia=np.diag([0.3, 0.4, 0.5]))
    builder.add_link("left_crank", parent="base", joint="left", xyz=[0.1, 0.2, 0.0], **rod(0.5, 0.3))
    builder.add_link("coupler", parent="left_crank", joint="knee", xyz=[0.3, 0.0, 0.0], **rod(0.8, 0.5))
    builder.add_link("right_crank", parent="base", joint="right", xyz=[0.6, 0.2, 0.0], **rod(0.6, 0.3))
    poses: Any = {"pose_a": at_x(0.5), "pose_b": at_x(0.3)}
    builder.close(oo.Loop("closing", "revolute", "coupler", "right_crank", project=True, **poses))
    return builder.build()


def warnings_of(model: oo.Model, joints: Any, rates: Any, duration: float) -> tuple[Any, list[str]]:
    q, v = model.neutral(), np.zeros(model.nv)
    q[7:], v[6:] = joints, rates
    v[:6] = [0.01, -0.02, 0.03, 0.2, -0.1, 0.3]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        trace = oo.Simulation(model, q, v, time_step=1e-3).run(duration)
    return trace, [str(one.message) for one in caught]


def test_a_singular_configuration_is_survived_and_named() -> None:
    model = parallelogram()
    trace, (message,) = warnings_of(model, [1.0, -1.0, 1.0], [-0.8, 0.8, -0.8], 4.0)
    crossed = float(trace.time[np.argmax(trace.q[:, 7] < 0.0)])
    assert message.startswith(
        "the constraints of the loop or mimic joint 'closing' of 'parallelogram' became"
    )
    named = float(message.split("near t = ")[1].split(" s")[0])
    assert 0.9 < crossed < 1.3 and abs(named - crossed) < 0.02
    assert np.abs(model.loop_errors(trace.q)).max() < 1e-12
    assert np.abs(trace.momentum - trace.momentum[0]).max() < 1e-12


def test_a_singular_start_is_named() -> None:
    trace, (message,) = warnings_of(parallelogram(), [0.0, 0.0, 0.0], [0.8, -0.8, 0.8], 1.0)
    assert "near t = 0.000000 s (singular configuration)" in message
    assert np.all(np.isfinite(trace.q))


def test_regular_loops_are_not_named() -> None:
    builder = linkage()
    builder.close(closing(project=True))
    model = builder.build()
    trace, caught = warnings_of(model, start(model)[7:], [2.0, 0.0, 0.0], 5.0)
    assert caught == [] and np.ptp(trace.q[:, 7]) > 1.0


def test_a_distance_of_coinciding_points_starts_apart() -> None:
    tree = linkage().build()
    q = start(tree)
    origin = np.linalg.inv(tree.frame_pose(q, "coupler")) @ tree.frame_pose(q, "base")
    loop = oo.Loop("rod", "distance", "base", "coupler", pose_b=origin, length=0.1, project=True)
    model = tree.with_loops([loop])
    assert model.loop_errors(q) == pytest.approx([-0.1], abs=1e-15)
    closed = model.closed_configuration(q)
    assert np.abs(model.loop_errors(closed)).max() < 1e-15
    trace = oo.Simulation(model, q, np.zeros(9), time_step=1e-3).run(0.01)
    assert np.all(np.isfinite(trace.q)) and np.abs(model.loop_errors(trace.q)).max() < 1e-14


@pytest.mark.parametrize("times", [(0.1, 0.1, 0.1), (0.1, 0.2, 0.3), (0.3, 0.1, 0.2)])
def test_brakes_on_all_joints_of_a_loop_hold_it(times: tuple[float, ...]) -> None:
    """The first brake stops the linkage; the others find joints at rest, whose rates are rounding errors."""
    model = linkage().build().with_loops([closing()])
    q = model.closed_configuration(start(model))
    v = model.closed_velocity(q, np.array([0.01, 0.02, -0.01, 0.1, -0.2, 0.3, 1.0, 0.0, 0.0]))
    names = model.joint_names
    events: list[Any] = [
        oo.Engage(f"hold_{name}", f"craft/{name}", at=t) for name, t in zip(names, times, strict=True)
    ]
    events += [oo.Disengage(f"free_{name}", f"craft/{name}", at=0.4) for name in names]
    craft = oo.System("craft", model, q, v, actuators=[oo.Brake(name, name) for name in names])
    trace: Any = oo.Simulation(oo.World([craft], events=events), time_step=1e-3).run(0.5)
    first, *others = sorted((e for e in trace.events if e.kind == "engage"), key=lambda e: e.time)
    assert first.energy_lost > 1e-3
    assert all(e.energy_lost < 1e-15 and np.abs(e.impulse).max() < 1e-12 for e in others)
    held = (trace.time > max(times)) & (trace.time < 0.4)
    assert np.abs(trace.v[held, 6:]).max() < 1e-14
    assert np.ptp(trace.q[held, 7:], axis=0).max() < 1e-14
    assert np.abs(trace.momentum - trace.momentum[0]).max() < 1e-13
    energy = trace.kinetic_energy + trace.dissipated
    assert np.ptp(energy) < 1e-9 * energy[0]
    assert trace.loops["closing"].opening.max() < 1e-14
    assert np.abs(trace.v[trace.time > 0.45, 6:]).max() > 1e-2  # free again, and moved by the turning base
