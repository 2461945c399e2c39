"""The gravity field of a run against an independent potential, differentiated by a complex step.

The reference shares no code with the engine's field: Legendre polynomials are differentiated symbolically,
and the motion is integrated by Picard's iteration on Chebyshev nodes. The Earth's rotation is shared; it is
tested against pyerfa elsewhere.
"""

from __future__ import annotations

from functools import cache
from math import factorial
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import chebyshev, legendre, polynomial

import onorbit_rs as oo
from onorbit_rs.tools.validation import nasa
from onorbit_rs.tools.validation.case import table
from onorbit_rs.tools.validation.fields import MU, RADIUS
from onorbit_rs.tools.validation.fields import field as of_table
from onorbit_rs.tools.validation.nasa import TYPICAL

# GGM02C (Center for Space Research, University of Texas, 2004), fully normalised, zero-tide: n, m, C, S
GGM02C = [(int(row["n"]), int(row["m"]), float(row["C"]), float(row["S"])) for row in table("ggm02c")]
EARTH = nasa.turning_earth()
HOURS_8 = 28_800.0


@cache
def legendre_slope(n: int, m: int) -> Any:
    """Returns `dᵐPn/duᵐ` as a normalised polynomial in u."""
    norm = np.sqrt((2 - (m == 0)) * (2 * n + 1) * factorial(n - m) / factorial(n + m))
    return norm * polynomial.polyder(legendre.leg2poly([0] * n + [1]), m)


def potential(r: Any, degree: int) -> Any:
    """Returns `(μ/r) [1 + Σ (R/r)ⁿ P̄nm(z/r) (C̄nm cos mλ + S̄nm sin mλ)]`, r (3, K) complex, planet axes."""
    x, y, z = r
    d = np.sqrt(x * x + y * y + z * z)
    total, u = np.ones_like(d), z / d
    # (r cos φ)ᵐ cos mλ and sin mλ, from the angle sum
    cos, sin = [np.ones_like(d)], [np.zeros_like(d)]
    for _ in range(degree):
        cos.append((x * cos[-1] - y * sin[-1]) / d)
        sin.append((x * sin[-1] + y * cos[-2]) / d)
    for n, m, c, s in GGM02C:
        if n <= degree:
            # P̄nm = cosᵐ φ dᵐPn/duᵐ
            slope = polynomial.polyval(u, legendre_slope(n, m))
            total = total + (RADIUS / d) ** n * slope * (c * cos[m] + s * sin[m])
    return MU / d * total


def gravity(r: Any, degree: int) -> Any:
    """Returns the gradient of the potential at r (K, 3) by an imaginary step of 1e-30 m."""
    steps = 1e-30j * np.eye(3)
    return np.stack([potential((r + step).T, degree).imag / 1e-30 for step in steps], axis=1)


@cache
def integrate(degree: int, segment: float = 600.0, nodes: int = 25) -> tuple[Any, Any]:
    """Returns the state (3,), (3,) after 8 h: iterates `v = v₀ + ∫ g dt`, `r = r₀ + ∫ v dt`."""
    x = -np.cos(np.pi * np.arange(nodes) / (nodes - 1))
    rising = chebyshev.chebint(np.linalg.inv(chebyshev.chebvander(x, nodes - 1)), lbnd=-1)
    integral = chebyshev.chebvander(x, nodes) @ rising * segment / 2
    r0, v0 = (np.array(part) for part in TYPICAL)
    for start in np.arange(0.0, HOURS_8, segment):
        t = start + (x + 1) * segment / 2
        rot_fi = EARTH.rotation(t)
        r = r0 + np.outer(t - start, v0)
        for _ in range(40):
            before = r
            in_f = gravity(np.einsum("tij,tj->ti", rot_fi, r), degree)
            v = v0 + integral @ np.einsum("tji,tj->ti", rot_fi, in_f)
            r = r0 + integral @ v
            if np.abs(r - before).max() < 2e-8:
                break
        else:
            raise AssertionError("it does not converge")
        r0, v0 = r[-1], v[-1]
    return r0, v0


def field(degree: int) -> oo.GravityField:
    return of_table("ggm02c", degree)


@cache
def simulated(degree: int) -> tuple[Any, Any]:
    """Runs NASA's station about its Kepler reference, 8 h at 1 s."""
    station = nasa.iss()
    trace = oo.Simulation(
        station, station.neutral(), np.zeros(6), orbit=oo.Kepler.from_state(*TYPICAL, mu=MU), earth=EARTH,
        environment=[field(degree)], time_step=1.0, record_every=28_800,
    ).run(HOURS_8)  # fmt: skip
    return np.array(trace.position_eci[-1]), np.array(trace.velocity_eci[-1])


def test_the_field_is_the_gradient_of_the_potential() -> None:
    r = np.random.default_rng(4).normal(size=(50, 3))
    r *= 6.7e6 / np.linalg.norm(r, axis=1)[:, None]
    point_mass = -MU * r / np.linalg.norm(r, axis=1)[:, None] ** 3
    for degree in (2, 4, 8):
        off = point_mass + field(degree).acceleration(r) - gravity(r, degree)
        assert np.abs(off).max() < 1e-14  # m/s² relative to 9: rounding
    assert np.abs(point_mass + field(8).acceleration(r) - gravity(r, 7)).max() > 1e-7


def test_nasa_3a_with_an_8x8_field() -> None:
    """NASA has no such table; the independent integration used here reproduces 3A, which is 4 x 4."""
    ours, independent = simulated(8), integrate(8)
    dr, dv = (np.linalg.norm(a - b) for a, b in zip(ours, independent, strict=True))
    print(f"8 x 8: {dr:.2e} m, {dv:.2e} m/s from an integration that shares no field")
    assert dr < 1e-3
    assert dv < 1e-6
    # negative control: four additional degrees matter
    assert np.linalg.norm(simulated(4)[0] - ours[0]) > 10.0


def test_the_independent_integration_reproduces_nasa_3a() -> None:
    """It agrees with 3A (JEOD) of NASA/TM-2015-218675 to 1.5 m, the difference of NASA's simulators."""
    position, _ = integrate(4)
    off = np.linalg.norm(position - nasa.rows("3A")[-1].position)
    print(f"4 x 4: {off:.3f} m from NASA's 3A")
    assert off < 1.5
    assert np.linalg.norm(simulated(4)[0] - position) < 1e-3


@pytest.mark.parametrize("name", ["humanoid_torso", "station_arm"])
def test_gravity_torques_of_a_robots_bodies_sum_to_the_composite_torque(name: str) -> None:
    """`T_i = -ε_ijk (I G)_jk` holds up to 20 L/r, but not if the forces on the bodies are omitted."""
    model = oo.robots.load(name)
    q = model.neutral()
    q[3:7] = np.array([0.3, -0.2, 0.5, 0.7]) / np.linalg.norm([0.3, -0.2, 0.5, 0.7])
    q[7:] = np.linspace(0.4, 1.6, model.nq - 7)
    own = field(8)
    trace = oo.Simulation(
        model, q, np.zeros(model.nv), orbit=oo.Numerical(*TYPICAL, environment=[own], earth=EARTH, mu=MU),
        earth=EARTH, environment=[own, oo.GravityGradient()], time_step=0.1, record_wrenches=True,
    ).run(0.1)  # fmt: skip
    poses = [model.frame_pose(q, body.name) for body in model.bodies]
    arms = np.array(
        [pose[:3, :3] @ body.com + pose[:3, 3] for pose, body in zip(poses, model.bodies, strict=True)]
    )
    center = trace.center_of_mass[0]
    wrench = trace.wrenches["gravity"][0] + trace.wrenches["gravity_gradient"][0]
    sums = np.cross(arms - center, wrench[:, :3]).sum(axis=0) + wrench[:, 3:].sum(axis=0)

    # inertia about the centre of mass from the mass matrix, and G by differences of the potential's gradient
    rot_wb = poses[0][:3, :3]
    at_base = model.mass_matrix(q)[3:6, 3:6]
    c = rot_wb.T @ (center - q[:3])
    inertia = rot_wb @ (at_base - model.mass * (c @ c * np.eye(3) - np.outer(c, c))) @ rot_wb.T
    rot_fi = EARTH.rotation(0.0)
    place, step = rot_fi @ (np.array(TYPICAL[0]) + center), 100.0 * np.eye(3)
    in_f = (gravity(place + step, 8) - gravity(place - step, 8)) / 200.0
    product = inertia @ rot_fi.T @ in_f @ rot_fi
    expected = -np.array(
        [product[1, 2] - product[2, 1], product[2, 0] - product[0, 2], product[0, 1] - product[1, 0]]
    )
    size = np.linalg.norm(arms - center, axis=1).max()
    bound = 20.0 * size / np.linalg.norm(place)
    off, alone = (
        np.linalg.norm(torque - expected) / np.linalg.norm(expected)
        for torque in (sums, wrench[:, 3:].sum(axis=0))
    )
    print(f"{name}: {off:.1e}, {off * np.linalg.norm(place) / size:.1e} L/r; torques alone {alone:.1e}")
    assert off < bound
    assert alone > 10.0 * bound  # an arm of 1.1 t beside 420 t; the error is larger with a free arm


def test_secular_rates_of_an_ellipse() -> None:
    """Curtis 12.2: periapsis 0.282 deg/h, node -0.172 deg/h; the mean anomaly has Kaula's rate.

    `Ṁ - n = (3/4) n J₂ (R/p)² √(1 - e²) (3 cos² i - 1)`, from periapsis to periapsis: there `r·v = 0`.
    """
    r, v = [-2384.46e3, 5729.01e3, 3050.46e3], [-7361.38, -2989.97, 1643.54]
    mu, j2, radius = 398600e9, 1.08263e-3, 6378e3
    orbit = oo.Kepler.from_state(r, v, mu=mu, secular_j2=True, j2=j2, radius=radius)
    ellipse = oo.Kepler.from_state(r, v, mu=mu)
    n, e, i = 2 * np.pi / ellipse.period, ellipse.eccentricity, ellipse.inclination

    def periapsis(guess: float) -> float:
        low, high = guess - 300.0, guess + 300.0
        while high - low > 1e-6:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if np.dot(*orbit.state(middle)) > 0 else (middle, high)
        return 0.5 * (low + high)

    def angles(t: float) -> Any:
        """Returns node and argument of periapsis at a passage of the periapsis."""
        x, v = orbit.state(t)
        u = np.arcsin(x[2] / np.linalg.norm(x) / np.sin(i))
        u = u if v[2] > 0 else np.pi - u
        return np.arctan2(x[1], x[0]) - np.arctan2(np.cos(i) * np.sin(u), np.cos(u)), u

    revolutions = 24
    first = periapsis(-ellipse.mean_anomaly / n % ellipse.period)
    drift = (
        0.75
        * n
        * j2
        * (radius / ellipse.semi_latus_rectum) ** 2
        * np.sqrt(1 - e**2)
        * (3 * np.cos(i) ** 2 - 1)
    )
    last = periapsis(first + revolutions * ellipse.period)
    assert revolutions * 2 * np.pi / (last - first) - n == pytest.approx(drift, rel=1e-3)
    assert abs(drift) > 1e-7  # rad/s
    turned = np.degrees(np.subtract(angles(last), angles(first)))
    node, apsis = ((turned + 180.0) % 360.0 - 180.0) / (last - first) * 3600.0
    print(f"node {node:.4f}, periapsis {apsis:.4f} deg/h")
    assert node == pytest.approx(-0.172, rel=0.01)
    assert apsis == pytest.approx(0.282, rel=0.01)
