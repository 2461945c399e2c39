"""The bundled release: a push without rotation, an arm that retreats, and the relative motion after it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.common.rotations import local_orbital_axes

EARTH = 3.986004418e14
"""Gravitational parameter of the scenario's orbit, m³/s²."""
ASKED = 0.05
"""Relative velocity of the centres of mass after the release, m/s."""


@pytest.fixture(scope="module")
def run() -> oo.Run:
    return oo.run("release_and_retreat", quiet=True)


def world(run: oo.Run) -> oo.WorldTrace:
    assert isinstance(run.trace, oo.WorldTrace)
    return run.trace


class Flight(NamedTuple):
    """Motion of the target's centre of mass relative to the servicer's, after the release."""

    t: Any
    """Times since the release, s."""
    apart: Any
    """Positions (T, 3) in L, m."""
    velocity: Any
    """Velocities (T, 3) in the rotating L, m/s."""
    rate: float
    """Angular rate of L, rad/s."""
    far: float
    """Largest distance of a centre of mass from the reference, m."""


def flight(run: oo.Run) -> Flight:
    trace = world(run)
    first = trace["target"]
    rows = np.flatnonzero(first.time >= trace.events[1].time)[1:]  # without the row before the release
    servicer, target = (np.asarray(trace[name].center_of_mass)[rows] for name in trace.names)
    eci = (first.reference_position_eci, first.reference_velocity_eci)
    position, velocity = (np.asarray(column)[rows] for column in eci)
    rot_wl = local_orbital_axes(position, velocity)
    rate = float(np.sqrt(EARTH / np.linalg.norm(position[0]) ** 3))
    apart = np.einsum("tji,tj->ti", rot_wl, target - servicer)
    moving = np.einsum("tji,tj->ti", rot_wl, relative_velocity(run)[rows])
    moving = moving - rate * np.cross([0.0, 0.0, 1.0], apart)
    far = float(np.linalg.norm(np.stack([servicer, target]), axis=-1).max())
    return Flight(np.asarray(first.time)[rows] - trace.events[1].time, apart, moving, rate, far)


def relative_velocity(run: oo.Run) -> Any:
    """Returns the velocity (T, 3) of the target relative to the servicer, centres of mass, W, m/s."""
    trace = world(run)
    servicer, target = (
        np.asarray(trace[name].momentum)[:, :3] / run.models[name].mass for name in trace.names
    )
    return target - servicer


def clohessy_wiltshire(t: Any, n: float, start: Any, velocity: Any) -> Any:
    """Returns the relative positions (T, 3) near a circular orbit: x radial, y along track, z across it.

    W. H. Clohessy and R. S. Wiltshire, Journal of the Aerospace Sciences 27(9), 1960.
    """
    (x, y, z), (u, v, w), s, c = start, velocity, np.sin(n * t), np.cos(n * t)
    return np.stack(
        [
            (4 - 3 * c) * x + s / n * u + 2 / n * (1 - c) * v,
            6 * (s - n * t) * x + y - 2 / n * (1 - c) * u + (4 * s - 3 * n * t) / n * v,
            c * z + s / n * w,
        ],
        axis=1,
    )


def test_the_certificate_passes_and_the_push_is_as_asked(run: oo.Run) -> None:
    assert run.summary["certificate_passed"], run.summary["certificate_failures"]
    assert not run.summary["warnings"]
    hold, let_go = world(run).events
    assert (hold.kind, hold.time, let_go.kind) == ("capture", 0.0, "release")
    assert hold.energy_lost < 1e-12  # both were at rest
    before, after = np.flatnonzero(world(run).time == let_go.time)
    still = np.abs(world(run)["servicer"].v[before, 6:]).max()
    assert still < 1e-5  # rad/s: the arm has settled
    relative = relative_velocity(run)
    push = relative[after] - relative[before]
    assert np.linalg.norm(push) == pytest.approx(ASKED, rel=1e-4)
    assert np.linalg.norm(relative[before]) < 1e-3  # m/s: the gravity gradient has started to turn the pair


def test_the_target_does_not_tumble_and_the_arm_does_not_recoil(run: oo.Run) -> None:
    row = np.flatnonzero(world(run).time == world(run).events[1].time)
    before, after = (np.asarray(world(run)["target"].v)[k, 3:6] for k in row)
    assert np.degrees(np.linalg.norm(after - before)) < 1e-3  # the push passes through the centre of mass
    servicer = np.asarray(world(run)["servicer"].v)
    assert np.degrees(np.linalg.norm(servicer[row[1], 3:6] - servicer[row[0], 3:6])) < 1e-2
    assert np.abs(servicer[row[1], 6:]).max() < 2e-3  # rad/s, of 0.15
    end = np.asarray(world(run)["target"].v)[-1, 3:6]
    assert np.degrees(np.linalg.norm(end)) < 0.05


def test_the_arm_retreats_to_its_stowed_posture(run: oo.Run) -> None:
    servicer = world(run)["servicer"]
    stowed = run.scenario.resolved()["systems"]["servicer"]["reference"]["points"][-1]
    assert np.abs(servicer.q[-1, 7:] - stowed).max() < 0.01
    limits = [joint.velocity for joint in run.models["servicer"].joints]
    assert np.all(np.abs(servicer.v[:, 6:]).max(axis=0) < limits)
    tool = run.models["servicer"].frame_pose(servicer.q[-1], "tool")
    handle = run.models["target"].frame_pose(world(run)["target"].q[-1], "handle")
    assert np.linalg.norm(handle[:3, 3] - tool[:3, 3]) > 5.0


def test_the_separation_follows_clohessy_and_wiltshire(run: oo.Run) -> None:
    """The orbit is circular, so that eccentricity causes no error; what remains is gravity's second order.

    The closed form neglects relative accelerations of at most `6 n² ρ²/r`, with the distance ρ from the
    reference: integrated twice, `3 (n t)² ρ²/r`.
    """
    t, apart, velocity, n, far = flight(run)
    expected = clohessy_wiltshire(t, n, apart[0], velocity[0])
    error = np.linalg.norm(apart - expected, axis=1).max()
    bound = 3.0 * (n * t[-1]) ** 2 * far**2 / np.cbrt(EARTH / n**2)
    print(f"off by {error:.1e} m, at most {bound:.1e} m from the second order")
    assert error < bound < 1e-4
    straight = apart[0] + np.outer(t, velocity[0])
    assert np.linalg.norm(apart - straight, axis=1).max() > 1.0  # the orbit does bend the path
    slower = clohessy_wiltshire(t, 0.99 * n, apart[0], velocity[0])
    assert np.linalg.norm(apart - slower, axis=1).max() > 100.0 * bound


def test_both_centres_of_mass_fall_as_points_under_true_gravity(run: oo.Run) -> None:
    """Point masses in inverse-square gravity, integrated here, have the second order: rounding remains."""
    t = flight(run).t
    found = []
    for name in ("servicer", "target"):
        system = world(run)[name]
        rows = np.flatnonzero(system.time >= world(run).events[1].time)[1:]
        place = np.asarray(system.reference_position_eci)[rows] + np.asarray(system.center_of_mass)[rows]
        speed = np.asarray(system.reference_velocity_eci)[rows[0]]
        speed = speed + np.asarray(system.momentum)[rows[0], :3] / run.models[name].mass
        found.append((place, fallen(t, place[0], speed)))
    (first, first_expected), (second, second_expected) = found
    error = np.linalg.norm((second - first) - (second_expected - first_expected), axis=1).max()
    print(f"off by {error:.1e} m")
    assert error < 1e-6


def fallen(t: Any, position: Any, velocity: Any) -> Any:
    """Returns the positions of a point mass at the times `t`, by RK4."""

    def rate(y: Any) -> Any:
        return np.concatenate([y[3:], -EARTH / np.linalg.norm(y[:3]) ** 3 * y[:3]])

    y, places = np.concatenate([position, velocity]), [position]
    for h in np.diff(t):
        a = rate(y)
        b = rate(y + h / 2 * a)
        c = rate(y + h / 2 * b)
        d = rate(y + h * c)
        y = y + h / 6 * (a + 2 * b + 2 * c + d)
        places.append(y[:3])
    return np.array(places)
