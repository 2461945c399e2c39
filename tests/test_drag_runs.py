"""Drag through the public ``Simulation``: dissipated energy, surfaces, invalid input.

NASA's run 6A and a decaying circle are in ``onorbit_rs.tools.validation``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.exceptions import EarthError, EffectError, FrameError, NotFoundError, ShapeError
from onorbit_rs.tools.validation.nasa import ELLIPTICAL, MU, simulate, sphere

# NASA/TM-2015-218675, run 6A at 28 800 s (JEOD's SIM_dyncomp): acceleration of the air
DRAG = np.array([-4.459432204135286e-07, 3.04449896012702e-07, 5.455748606342244e-07])

SPHERE = sphere()
BALL = oo.Cannonball(1.0, drag_coefficient=0.02)
AIR = oo.ConstantAtmosphere(1.4e-12)


def test_the_drag_of_run_6a_agrees_with_nasa() -> None:
    trace = simulate("6A")
    q, v, r = np.array(trace.q[-1]), np.array(trace.acceleration[-1]), np.array(trace.position_eci[-1])
    origin = r - q[:3]
    gravity = -MU * r / np.linalg.norm(r) ** 3 + MU * origin / np.linalg.norm(origin) ** 3
    in_w = matrix_from_quaternion(q[3:7]) @ (v[:3] + np.cross(trace.v[-1, 3:], trace.v[-1, :3]))
    assert np.abs(in_w - gravity - DRAG).max() < 1e-11  # half of the error of the final position


def test_the_energy_lost_equals_the_work_of_drag() -> None:
    # a tumbling box: ∫ (F·v + T·ω) dt from the formula, integrated here, against the orbit's and the
    # spin's energy
    model = oo.Model.rigid_body(2.0, np.diag([0.3, 0.4, 0.5]))
    areas = [0.5, 0.5, 0.2, 0.2]
    normals = np.array([[1.0, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]])
    centroids = np.array([[0.3, 0.4, 0], [-0.3, 0, 0.2], [0, 0.5, 0], [0, -0.5, 0]])
    density = 1e-9
    orbit = oo.Kepler.from_state(*ELLIPTICAL, mu=MU)
    v = np.array([0.0, 0, 0, 0.4, -0.3, 0.2])
    sim = oo.Simulation(
        model, model.neutral(), v, orbit=orbit, earth=oo.Earth(rotation="about_z", rate=0.0),
        environment=[oo.Drag(
            oo.ConstantAtmosphere(density),
            surfaces=oo.Plates(areas, normals, centroids, drag_coefficient=2.0),
        )],
        time_step=0.05,
    )  # fmt: skip
    trace = sim.run(60.0)
    x, y, z, w = np.array(trace.q)[:, 3:7].T
    rot = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]).transpose(2, 0, 1)  # fmt: skip
    velocity = np.einsum("tji,tj->ti", rot, trace.velocity_eci)
    spin = np.array(trace.v)[:, 3:6]
    power = np.zeros(len(x))
    for area, normal, centroid in zip(areas, normals, centroids, strict=True):
        u = velocity + np.cross(spin, centroid)
        force = -0.5 * density * 2.0 * area * np.maximum(u @ normal, 0.0)[:, None] * u
        power += np.einsum("ti,ti->t", force, u)  # F·v + (c × F)·ω
    taken = np.sum(0.5 * (power[1:] + power[:-1])) * 0.05
    energy = [
        0.5 * 2.0 * np.sum(np.square(trace.velocity_eci[k]))
        - 2.0 * MU / np.linalg.norm(trace.position_eci[k])
        + 0.5 * spin[k] @ np.diag([0.3, 0.4, 0.5]) @ spin[k]
        for k in (0, -1)
    ]  # fmt: skip
    assert taken < -10.0
    assert energy[1] - energy[0] == pytest.approx(taken, rel=1e-5)


def test_default_surfaces_are_the_faces_of_the_robot() -> None:
    robot = oo.robots.load("humanoid_torso")
    orbit = oo.Kepler.from_state(*ELLIPTICAL, mu=MU)
    earth = oo.Earth("2024-03-01T12:00:00 UTC")
    effects = [oo.Drag(oo.ExponentialAtmosphere()), oo.RadiationPressure()]
    sim = oo.Simulation(
        robot, robot.neutral(), np.zeros(robot.nv), orbit=orbit, earth=earth, environment=effects
    )
    trace = sim.run(0.01)
    momentum = np.array(trace.momentum[-1])
    assert 0.0 < np.linalg.norm(momentum[:3]) < 1e-3
    assert np.linalg.norm(momentum[3:]) > 0.0  # the robot is not symmetric: drag rotates it
    # one link has less drag
    part = oo.Drag(oo.ExponentialAtmosphere(), surfaces={robot.body_names[1]: oo.Faces()})
    sim = oo.Simulation(
        robot, robot.neutral(), np.zeros(robot.nv), orbit=orbit, earth=earth, environment=[part]
    )
    assert np.linalg.norm(sim.run(0.01).momentum[-1][:3]) < 0.5 * np.linalg.norm(momentum[:3])


def test_invalid_settings_are_rejected_with_a_fix() -> None:
    orbit = oo.Kepler.from_state(*ELLIPTICAL, mu=MU)
    robot = oo.robots.load("humanoid_torso")

    def simulate(
        effect: oo.Effect, earth: Any = None, model: oo.Model = SPHERE, orbit: Any = orbit
    ) -> oo.Trace:
        sim = oo.Simulation(
            model, model.neutral(), np.zeros(model.nv), orbit=orbit, earth=earth, environment=[effect]
        )
        return sim.run(0.01)

    still = oo.Earth(rotation="about_z", rate=0.0)
    with pytest.raises(EffectError, match="area is -1"):
        oo.Cannonball(-1.0)
    with pytest.raises(EffectError, match="add up to more than 1") as caught:
        oo.Faces(specular=0.6, diffuse=0.6)
    assert caught.value.got == (0.6, 0.6)
    with pytest.raises(EffectError, match="normal of plate 0"):
        oo.Plates([1.0], [[0.0, 0, 0]], [[0.0, 0, 0]])
    with pytest.raises(ShapeError, match="normals has shape"):
        oo.Plates([1.0], [1.0, 0, 0], [[0.0, 0, 0]])
    with pytest.raises(EffectError, match="density is -1"):
        oo.ConstantAtmosphere(-1.0)
    with pytest.raises(EffectError, match="flux is -1"):
        oo.RadiationPressure(flux=-1.0)
    with pytest.raises(EffectError, match="requires the rotation of the Earth"):
        simulate(oo.Drag(AIR, surfaces=BALL))
    with pytest.raises(EarthError, match="epoch"):
        simulate(oo.RadiationPressure(surfaces=BALL), still)
    with pytest.raises(EffectError, match="no visual geometry"):
        simulate(oo.Drag(AIR), still)
    with pytest.raises(EffectError, match="name the one with this surface"):
        simulate(oo.Drag(AIR, surfaces=BALL), still, robot)
    with pytest.raises(FrameError, match="arm"):
        simulate(oo.Drag(AIR, surfaces={"arm": BALL}), still, robot)
    low = oo.Kepler.from_state((6.37e6, 0, 0), (0, 7900.0, 0), mu=MU)  # above the ground at the poles only
    with pytest.raises(EffectError, match="below the ellipsoid of the Earth"):
        simulate(oo.Drag(AIR, surfaces=BALL), still, orbit=low)


def test_the_atmosphere_can_be_evaluated_directly() -> None:
    air = oo.ExponentialAtmosphere()
    assert air.density(500e3) == 6.967e-13
    assert np.array_equal(air.density([500e3, 600e3]), [6.967e-13, 1.454e-13])
    assert air.density(np.full((2, 1), 400e3), [0.0, 0.1, 0.2]).shape == (2, 3)
    one = oo.ExponentialAtmosphere(density=1e-12, altitude=400e3, scale_height=50e3)
    assert one.density(450e3) == pytest.approx(1e-12 / np.e, rel=1e-14)
    earth = oo.Earth("2024-03-01T12:00:00 UTC")
    r = np.array([[6.9e6, 0.0, 0.0], [0.0, 0.0, 6.9e6]])
    low, high = air.density_at(r, 10.0, earth=earth)
    assert high < low  # the pole is 21 km closer to the centre
    latitude, longitude, altitude = earth.geodetic(10.0, r[0])
    assert air.density_at(r[0], 10.0, earth=earth) == pytest.approx(
        air.density(altitude, latitude, longitude)
    )
    with pytest.raises(EffectError, match="below the ellipsoid of the Earth") as caught:
        air.density(-1.0)
    assert caught.value.got == -1.0
    with pytest.raises(EffectError, match="use an exponential atmosphere or NRLMSISE-00"):
        oo.HarrisPriester().density(1001e3, earth=earth)
    with pytest.raises(EarthError, match="requires an epoch"):
        oo.HarrisPriester().density(400e3)
    with pytest.raises(ShapeError, match="do not match; give numbers"):
        air.density([1.0, 2.0], [1.0, 2.0, 3.0])


def test_nrlmsise_requires_space_weather(tmp_path: Any) -> None:
    earth = oo.Earth("2024-03-01T07:00:00 UTC")
    air = oo.Nrlmsise00(f107=150.0, f107a=140.0, ap=12.0)
    history = oo.Nrlmsise00(f107=150.0, f107a=140.0, ap=[12.0] * 7)
    assert air.density(400e3, 0.1, 0.2, earth=earth) == pytest.approx(
        history.density(400e3, 0.1, 0.2, earth=earth), rel=0.05
    )
    with pytest.raises(EffectError, match="lacks f107a, ap"):
        oo.Nrlmsise00(f107=150.0)
    with pytest.raises(EffectError, match="Ap, not Kp"):
        oo.Nrlmsise00(f107=150.0, f107a=150.0, ap=-1.0)
    with pytest.raises(NotFoundError, match="space weather table"):
        oo.Nrlmsise00(table=tmp_path / "none.csv")
    table = tmp_path / "sw.csv"
    table.write_text("DATE,AP_AVG,F10.7_OBS,F10.7_OBS_CENTER81\n2024-02-29,12,150,139\n2024-03-01,12,,140\n")
    read = oo.Nrlmsise00(table=table)
    assert read.density(400e3, earth=earth) == air.density(400e3, earth=earth)
    with pytest.raises(EffectError, match="outside the table") as caught:
        read.density(400e3, t=86_400.0, earth=earth)
    assert caught.value.expected == ("2024-02-29", "2024-03-01")


def test_the_trace_records_drag_and_radiation_pressure() -> None:
    orbit = oo.Kepler.from_state(*ELLIPTICAL, mu=MU)
    earth = oo.Earth("2024-03-01T12:00:00 UTC")
    effects = [oo.Drag(AIR, surfaces=BALL), oo.RadiationPressure(surfaces=BALL, shadow=False)]
    sim = oo.Simulation(
        SPHERE, SPHERE.neutral(), np.zeros(6), orbit=orbit, earth=earth, environment=effects, time_step=1.0,
        record_wrenches=True,
    )  # fmt: skip
    trace = sim.run(2.0)
    assert set(trace.wrenches) >= {"drag", "radiation_pressure"}
    r, v = np.array(trace.position_eci[0]), np.array(trace.velocity_eci[0])
    u = v - np.cross(earth.angular_velocity(0.0), r)
    drag = np.array(trace.wrenches["drag"])[0, 0]
    assert drag[:3] == pytest.approx(-0.5 * 1.4e-12 * 0.02 * np.linalg.norm(u) * u, rel=1e-12)
    to_sun = earth.sun(0.0) - r
    distance = np.linalg.norm(to_sun)
    light = np.array(trace.wrenches["radiation_pressure"])[0, 0]
    pressure = 1361.0 / 299_792_458.0 * (149_597_870_700.0 / distance) ** 2
    assert light[:3] == pytest.approx(-pressure * to_sun / distance, rel=1e-12)
    assert not np.any(drag[3:]) and not np.any(light[3:])
