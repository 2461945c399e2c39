"""Gravity modes on references that are not in free fall: the robot departs from them, or is carried.

The path is a circle flown 2 % too fast, so that `g - r̈_ref` is known in closed form.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import OnOrbitError, OrbitError

RADIUS, DURATION = 7e6, 600.0
RATE = 1.02 * np.sqrt(oo.MU_EARTH / RADIUS**3)
MODEL = oo.Model.rigid_body(10.0, np.diag([1.0, 2.0, 2.5]))


def circle(t: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns position, velocity and acceleration, (T, 3)."""
    up = np.stack([np.cos(RATE * t), np.sin(RATE * t), 0.0 * t], axis=-1)
    along = np.stack([-np.sin(RATE * t), np.cos(RATE * t), 0.0 * t], axis=-1)
    return RADIUS * up, RADIUS * RATE * along, -RADIUS * RATE**2 * up


def too_fast(mu: float | None = oo.MU_EARTH) -> oo.CustomPath:
    times = np.arange(0.0, DURATION + 1.0, 10.0)
    r, v, a = circle(times)
    return oo.CustomPath(times, r, velocities=v, accelerations=a, mu=mu)


def released(mode: Any, offset: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> oo.Trace:
    """Runs a robot released at rest in W."""
    q = MODEL.neutral()
    q[:3] = offset
    simulation = oo.Simulation(MODEL, q, np.zeros(6), orbit=too_fast(), gravity_mode=mode, time_step=1.0)
    return simulation.run(DURATION)


def off_free_fall(trace: oo.Trace) -> float:
    """Returns the final distance from two-body motion with the same initial absolute state, m."""
    fall = oo.Kepler.from_state(trace.position_eci[0], trace.velocity_eci[0])
    return float(np.linalg.norm(fall.state(DURATION)[0] - trace.position_eci[-1]))


def off_tides(trace: oo.Trace) -> float:
    """Returns the final distance from `ẍ = g(R + x) - g(R)` on the exact circle, integrated here, m."""

    def rate(t: float, x: np.ndarray) -> np.ndarray:
        r = circle(np.array(t))[0]
        pull = [-oo.MU_EARTH * p / np.linalg.norm(p) ** 3 for p in (r + x[:3], r)]
        return np.concatenate([x[3:], pull[0] - pull[1]])

    x, h = np.concatenate([trace.q[0, :3], np.zeros(3)]), 2.0
    for t in np.arange(0.0, DURATION, h):
        k1 = rate(t, x)
        k2 = rate(t + h / 2, x + h / 2 * k1)
        k3 = rate(t + h / 2, x + h / 2 * k2)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(t + h, x + h * k3))
    return float(np.linalg.norm(x[:3] - trace.q[-1, :3]))


def test_in_true_mode_the_robot_moves_on_a_kepler_orbit() -> None:
    trace = released("true", (10.0, -5.0, 3.0))
    assert np.linalg.norm(trace.q[-1, :3]) > 10e3  # ½ · 0.33 m/s² · (600 s)²: the robot did depart
    assert off_free_fall(trace) < 1e-4  # relative to 59 km; the path's third derivative is discontinuous
    assert trace.reference_residual is None


def test_in_carried_mode_only_tides_move_the_robot() -> None:
    at_reference = released("carried")
    assert np.abs(at_reference.q[:, :3]).max() == 0.0
    trace = released("carried", (10.0, -5.0, 3.0))
    assert off_tides(trace) < 1e-6
    # g - r̈_ref = (ω² R - μ/R²) up
    residual = np.linalg.norm(trace.reference_residual, axis=1)
    np.testing.assert_allclose(residual, RATE**2 * RADIUS - oo.MU_EARTH / RADIUS**2, rtol=1e-6)


def test_each_mode_fails_the_test_of_the_other() -> None:
    assert off_free_fall(released("carried", (10.0, -5.0, 3.0))) > 1e3
    assert off_tides(released("true", (10.0, -5.0, 3.0))) > 1e3


def test_both_modes_agree_on_a_kepler_orbit() -> None:
    q = MODEL.neutral()
    q[:3] = 10.0, 0.0, 0.0
    orbit = oo.Kepler(semi_major_axis=7.2e6, eccentricity=0.1)
    modes: tuple[Any, Any] = ("true", "carried")
    traces = [
        oo.Simulation(MODEL, q, np.zeros(6), orbit=orbit, gravity_mode=mode, time_step=1.0).run(100.0)
        for mode in modes
    ]
    np.testing.assert_array_equal(traces[0].q, traces[1].q)
    assert not np.any(traces[1].reference_residual)


def test_the_residual_on_sgp4_is_the_acceleration_by_j2() -> None:
    line1 = "1 28057U 03049A   06177.78615833  .00000060  00000-0  35940-4 0  1836"
    line2 = "2 28057  98.4283 247.6961 0000884  88.1964 271.9322 14.35478080140550"
    orbit = oo.Sgp4(line1, line2)
    simulation = oo.Simulation(
        MODEL, MODEL.neutral(), np.zeros(6), orbit=orbit, gravity_mode="carried", time_step=10.0
    )
    trace = simulation.run(orbit.period)
    # g_J2 = -(3/2) J2 μ a²/r⁴ [(1 - 5 z²/r²) r̂ + 2 z/r ẑ]; the rest (J3, J4, drag) is small
    r = trace.position_eci
    distance = np.linalg.norm(r, axis=1)[:, None]
    z = r[:, 2:] / distance
    j2 = -1.5 * 1.082616e-3 * 3.986008e14 * 6.378135e6**2 / distance**4
    flattening = j2 * ((1.0 - 5.0 * z**2) * r / distance + 2.0 * z * np.array([0.0, 0.0, 1.0]))
    assert np.linalg.norm(trace.reference_residual + flattening, axis=1).max() < 1e-3
    assert np.linalg.norm(flattening, axis=1).max() > 1e-2


def test_wrong_modes_and_missing_planets_are_rejected() -> None:
    bad: Any = "free"
    with pytest.raises(OnOrbitError, match="it must be 'true' or 'carried'"):
        oo.Simulation(MODEL, MODEL.neutral(), np.zeros(6), gravity_mode=bad)
    with pytest.raises(OrbitError, match="its planet's mu"):
        oo.Simulation(
            MODEL, MODEL.neutral(), np.zeros(6), orbit=too_fast(None), environment=[oo.GravityGradient()]
        )
    inside = oo.FixedFrame(position=[1e6, 0.0, 0.0], mu=oo.MU_EARTH)
    with pytest.raises(OnOrbitError, match="1000000 m from the planet's centre"):
        oo.Simulation(MODEL, MODEL.neutral(), np.zeros(6), orbit=inside).run(1.0)


def test_a_run_beyond_the_end_of_its_path_is_rejected() -> None:
    simulation = oo.Simulation(MODEL, MODEL.neutral(), np.zeros(6), orbit=too_fast(), time_step=1.0)
    with pytest.raises(OrbitError, match="the path covers 0 s to 600 s") as caught:
        simulation.run(DURATION + 5.0)
    assert caught.value.end == DURATION
    assert caught.value.trace is not None


@pytest.mark.parametrize(("tolerance", "gate"), [(1e-5, 1e-4), (1e-7, 1e-6), (1e-9, 1e-7)])
def test_adaptive_steps_resolve_the_knots_of_a_path(tolerance: float, gate: float) -> None:
    """Free fall from cubic splines against two-body motion; steps across knots once caused errors of mm."""
    start = oo.Kepler(semi_major_axis=RADIUS, eccentricity=0.01, inclination=0.5)
    times = np.arange(0.0, 62.0, 2.0)
    r, _ = start.state(times)
    r = r + 50.0 * np.sin(times / 15.0)[:, None] * np.array([0.0, 0.0, 1.0])
    path = oo.CustomPath(times, r, mu=oo.MU_EARTH)
    trace = oo.Simulation(
        MODEL, MODEL.neutral(), np.zeros(6), orbit=path, integrator="dormand_prince", tolerance=tolerance,
        time_step=1.0,
    ).run(60.0)  # fmt: skip
    free = oo.Kepler.from_state(*path.state(0.0))
    assert np.linalg.norm(trace.position_eci[-1] - free.state(60.0)[0]) < gate
