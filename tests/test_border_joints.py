"""Joints at rest and at their limits, and integrators, through Python."""

from __future__ import annotations

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import InputError


def slider(friction: float = 0.0) -> oo.Model:
    """Returns a block of 5 kg that slides by up to 0.1 m on a base of 20 kg."""
    builder = oo.ModelBuilder("slider", base="base", mass=20.0, inertia=np.eye(3))
    builder.add_link(
        "block", parent="base", joint="slide", kind="prismatic", axis=np.array([1.0, 0, 0]), mass=5.0,
        inertia=np.eye(3), friction=friction, lower=-0.1, upper=0.1,
    )  # fmt: skip
    return builder.build()


V = np.array([0.0, 0, 0, 0, 0, 0, 0.5])


def test_limits_are_enforced_on_request_and_reported_otherwise() -> None:
    model = slider()
    free = oo.Simulation(model, model.neutral(), V).run(1.0)
    assert free.joint_limits_exceeded() == ["slide"]
    kept = oo.Simulation(model, model.neutral(), V, enforce_limits=True, restitution=0.5).run(1.0)
    assert kept.joint_limits_exceeded() == []
    assert np.abs(kept.q[:, 7]).max() <= 0.1 + 1e-12
    lost = kept.kinetic_energy[0] - kept.kinetic_energy[-1]
    assert kept.dissipated[-1] == pytest.approx(lost, rel=1e-12)
    assert all(passed for *_, passed in kept.certificate())


def test_an_initial_position_outside_a_limit_names_the_joint() -> None:
    model = slider()
    q = model.neutral()
    q[7] = 0.2
    with pytest.raises(InputError, match="slide") as caught:
        oo.Simulation(model, q, V, enforce_limits=True)
    assert caught.value.expected == (-0.1, 0.1)


@pytest.mark.parametrize(
    ("settings", "name"),
    [({"tolerance": 1.0}, "tolerance"), ({"enforce_limits": True, "restitution": 2.0}, "restitution")],
)
def test_settings_out_of_range_are_named(settings: dict[str, float], name: str) -> None:
    model = slider()
    with pytest.raises(InputError, match=name):
        oo.Simulation(model, model.neutral(), V, **settings)  # type: ignore[arg-type]


def test_integrators_are_listed_and_rollouts_have_fixed_steps() -> None:
    model = slider()
    with pytest.raises(InputError, match="dormand_prince"):
        oo.Simulation(model, model.neutral(), V, integrator="rk5")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="rk4"):
        oo.rollout(model, model.neutral()[None], V[None], steps=2, integrator="dormand_prince")


def test_adaptive_steps_leave_rows_on_the_grid() -> None:
    model = slider(friction=2.0)
    simulation = oo.Simulation(model, model.neutral(), V, integrator="dormand_prince", time_step=0.1)
    trace = simulation.run(2.0)
    assert np.allclose(trace.time, 0.1 * np.arange(21), rtol=0, atol=1e-12)
    assert trace.v[-1, 6] == 0.0  # sticks
    assert trace.q[-1, 7] == pytest.approx(0.5 * 0.5**2 * 4.0 / 2.0, rel=1e-12)  # μ u²/2f


@pytest.mark.parametrize("time_step", [0.01, 5.0, 20.0])
def test_recorded_rows_do_not_affect_restitution(time_step: float) -> None:
    """Stops once became inelastic after 32 bounces within a ``time_step``, the interval of rows."""
    simulation = oo.Simulation(
        slider(), slider().neutral(), V, enforce_limits=True, restitution=1.0,
        integrator="dormand_prince", time_step=time_step,
    )  # fmt: skip
    trace = simulation.run(40.0)
    assert trace.kinetic_energy[-1] == pytest.approx(trace.kinetic_energy[0], rel=1e-8)


def test_infinitely_many_bounces_end() -> None:
    """Each bounce takes nine tenths of the time of the previous one: infinitely many in 0.04 s."""
    builder = oo.ModelBuilder("pushed", base="base", mass=1e6, inertia=1e6 * np.eye(3))
    builder.add_link(
        "block", parent="base", joint="slide", kind="prismatic", axis=np.array([1.0, 0, 0]), mass=1.0,
        inertia=np.eye(3), lower=-10.0, upper=0.1,
    )  # fmt: skip
    model = builder.build()

    class ConstantTorque(oo.Controller):
        def update(self, t: float, state: oo.State) -> np.ndarray:
            return np.array([50.0])

    trace = oo.Simulation(
        model, model.neutral(), np.array([0, 0, 0, 0, 0, 0, 0.1]), controller=ConstantTorque(),
        enforce_limits=True, restitution=0.9, time_step=0.01,
    ).run(2.0)  # fmt: skip
    assert trace.v[-1, 6] == 0.0 and trace.q[-1, 7] == pytest.approx(0.1, abs=1e-12)


def test_a_body_in_pure_translation_passes_its_certificate() -> None:
    model = oo.Model.rigid_body(50.0, np.diag([3.0, 4.0, 5.0]))
    q = model.neutral()
    q[:3] = [3.0, -2.0, 1.0]
    orbit = oo.Kepler(semi_major_axis=7e6)
    trace = oo.Simulation(model, q, np.array([0.1, 0.2, -0.1, 0, 0, 0]), orbit=orbit, time_step=0.1).run(20.0)
    assert all(passed for *_, passed in trace.certificate())
