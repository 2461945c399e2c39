"""The bundled scenarios of the orbital environment do what their descriptions say."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.common.rotations import attitude_in_orbit, matrix_from_quaternion
from onorbit_rs.scenario import Scenario, load

# ETS-VII's numbers are as published
pytestmark = pytest.mark.filterwarnings("ignore:the inertia of link 'link_5'")


def run(name: str, change: Any = None, **simulation: Any) -> oo.Run:
    data = load(name).resolved()
    data["simulation"] |= simulation
    if change:
        change(data)
    return oo.run(Scenario(**data), quiet=True)


def center_of_mass(result: oo.Run) -> tuple[Any, Any]:
    """Returns position and velocity of the centre of mass from the planet's centre, (T, 3) each."""
    trace = result.trace
    base = matrix_from_quaternion(trace.q[:, 3:7]) @ trace.v[:, :3, None]
    origin = trace.position_eci - trace.q[:, :3], trace.velocity_eci - base[..., 0]
    return origin[0] + trace.center_of_mass, origin[1] + trace.momentum[:, :3] / result.model.mass


def test_hill_relative_agrees_with_the_closed_form() -> None:
    result = run("hill_relative", record_every=20)
    t = result.trace.time
    chief = oo.Kepler(semi_major_axis=6778.137e3, inclination=np.radians(51.6))
    position, velocity = oo.relative.to_lvlh(chief, t, *center_of_mass(result))
    start = np.concatenate([position[0], velocity[0]])

    def off(mean_motion: float) -> float:
        closed = (oo.relative.hill_transition(mean_motion, t) @ start)[:, :3]
        return float(np.linalg.norm(position - closed, axis=1).max())

    n = 2.0 * np.pi / chief.period
    print(f"hill: {off(n):.3f} m from the closed form")
    assert off(n) < 0.05  # second order in the distance: 0.02 m of 400
    assert off(1.01 * n) > 5.0  # negative control
    # twice as long as high, and constant amplitude across the orbit
    high, wide, across = np.ptp(position, axis=0)
    assert wide / high == pytest.approx(2.0, rel=0.02)
    assert across == pytest.approx(2.0 * start[2], rel=0.02)


SIDES = np.array(
    [[2.0, 2.0, 2.0], [1.8, 4.8, 0.04], [1.8, 4.8, 0.04]]
)  # offsets of body and wings, common axes, m


def test_geo_radiation_is_dark_for_an_hour_a_day() -> None:
    result = run("geo_radiation", record_every=6)
    trace = result.trace
    force = np.linalg.norm(trace.wrenches["radiation_pressure"][:, :, :3].sum(axis=1), axis=1)
    dark = force == 0.0
    edges = np.flatnonzero(np.diff(dark.astype(int)))
    assert len(edges) == 4 and not dark[0], "one umbra a day"
    begins, ends = trace.time[edges[::2]], trace.time[edges[1::2]]
    print("geo:", (ends - begins) / 60.0, "min")
    # central: disc of the Earth, 17.4 degrees, minus that of the Sun, 0.53, at 4 min per degree: 67 min
    assert np.all((ends - begins > 60.0 * 60.0) & (ends - begins < 70.0 * 60.0))
    assert begins[1] - begins[0] == pytest.approx(86_164.0 + 236.0, abs=300.0)  # a solar day

    # more than P A of base and wings, less than with full reflection (1.4 P A) and the arm
    earth = oo.Earth("2026-03-20T00:00:00 UTC")
    to_sun = earth.sun(trace.time) - trace.position_eci
    distance = np.linalg.norm(to_sun, axis=1)
    pressure = 1361.0 / 299_792_458.0 * (149_597_870_700.0 / distance) ** 2
    in_body = np.einsum("tji,tj->ti", matrix_from_quaternion(trace.q[:, 3:7]), to_sun / distance[:, None])
    faces = SIDES[:, [1, 2, 0]] * SIDES[:, [2, 0, 1]]
    seen = np.abs(in_body) @ faces.sum(axis=0)
    share = force / (pressure * seen)
    lit = ~dark & ~np.roll(dark, 20) & ~np.roll(dark, -20)  # away from the penumbra
    print("geo:", share[lit].min(), share[lit].max(), "P A")
    assert np.all((share[lit] > 1.0) & (share[lit] < 1.6))


def test_leo_drag_tumble_loses_the_work_of_drag() -> None:
    def without_air(data: Any) -> None:
        data["environment"] = [effect for effect in data["environment"] if effect["kind"] != "drag"]

    braked = run("leo_drag_tumble", duration=1800.0)
    free = run("leo_drag_tumble", without_air, duration=1800.0)

    def energy(result: oo.Run) -> Any:
        """Returns the orbital energy with J₂, J."""
        r, v = center_of_mass(result)
        d = np.linalg.norm(r, axis=1)
        j2 = 1.0826e-3 * (6378137.0 / d) ** 2 * (1.5 * (r[:, 2] / d) ** 2 - 0.5)
        return result.model.mass * (0.5 * np.sum(v * v, axis=1) - oo.MU_EARTH / d * (1.0 - j2))

    lost = energy(braked) - energy(free)
    _, velocity = center_of_mass(braked)
    force = braked.trace.wrenches["drag"][:, :, :3].sum(axis=1)
    power = np.einsum("ti,ti->t", force, velocity)
    t = braked.trace.time
    taken = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(t))])
    print(f"drag: {lost[-1] / 1e3:.3f} kJ lost, {taken[-1] / 1e3:.3f} kJ taken")
    assert np.all(power < 0.0)
    assert taken[-1] < -1e5
    for row in (len(t) // 3, len(t) // 2, -1):
        assert lost[row] == pytest.approx(taken[row], rel=1e-4)
    # while tumbling, the wings are edge on and face on to the air
    assert power.min() / power.max() > 2.0


def test_iss_gravity_gradient_librates_with_the_period_of_linear_theory() -> None:
    result = run("iss_gravity_gradient", record_every=10)
    trace, model = result.trace, result.model
    angles = attitude_in_orbit(trace.q[:, 3:7], trace.position_eci, trace.velocity_eci)
    assert np.degrees(np.abs(angles - [0.0, 0.0, np.pi / 2])).max() < 15.0
    torque = trace.wrenches["gravity_gradient"][:, :, 3:].sum(axis=1)
    assert (
        0.1 < np.linalg.norm(torque, axis=1).max() < 1e3
    )  # N m; 3 n² times 1e8 kg m² at angles of degrees is about 20

    # linear theory about the orbit's normal z, of the whole robot, x up: ω² = 3 n² (I_y - I_x)/I_z
    q = trace.q[0]
    c = model.center_of_mass(q) - q[:3]
    c = matrix_from_quaternion(q[3:7]).T @ c
    inertia = model.mass_matrix(q)[3:6, 3:6] - model.mass * (c @ c * np.eye(3) - np.outer(c, c))
    x, y, z = np.linalg.eigvalsh(inertia)
    n = np.sqrt(oo.MU_EARTH / 6798e3**3)
    expected = 2.0 * np.pi / (n * np.sqrt(3.0 * (y - x) / z))

    def left_over(period: float) -> float:
        """Returns the sum of squared residuals after fitting a sine of this period, s."""
        phase = 2.0 * np.pi / period * trace.time
        terms = np.stack([np.ones_like(phase), np.cos(phase), np.sin(phase)], axis=1)
        return float(np.linalg.lstsq(terms, angles[:, 2], rcond=None)[1][0])

    periods = np.linspace(0.5, 2.0, 601) * expected
    best = periods[np.argmin([left_over(period) for period in periods])]
    print(f"iss: {best:.0f} s, linear theory {expected:.0f} s")
    assert best == pytest.approx(expected, rel=0.01)
    assert np.degrees(np.ptp(angles[:, 2])) > 2.0
