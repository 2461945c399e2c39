"""Bundled spacecraft for capture: masses, inertias, frames, shapes, and the arm of the servicer."""

from __future__ import annotations

import warnings
from xml.etree import ElementTree

import numpy as np
import pytest

import onorbit_rs as oo

MASSES = {"ets_vii_target": 410.0, "servicer": 1088.0, "small_satellite": 400.0, "target_satellite": 500.0}
GRASP = [0.0, 1.4260230832, 0.0, 1.3391380305, 0.0, -1.1943647869, 0.0]
"""Joint angles of the servicer with the tool 2 m in front of the bus, rad."""
FRONT = 0.8
"""Position of the front face of the servicer's bus, m."""


@pytest.fixture(scope="module", params=sorted(MASSES))
def model(request: pytest.FixtureRequest) -> oo.Model:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return oo.robots.load(request.param)


def moments(inertia: object) -> np.ndarray:
    return np.linalg.eigvalsh(np.array(inertia, dtype=float))


def test_masses_and_inertias_are_those_of_rigid_bodies(model: oo.Model) -> None:
    assert model.mass == pytest.approx(MASSES[model.name], rel=1e-14)
    assert not model.warnings
    for body in model.bodies:
        least, middle, most = moments(body.inertia)
        assert least > 0.0 and least + middle > most, body.name


def test_every_link_of_the_file_has_a_rigid_body_s_inertia(model: oo.Model) -> None:
    robot = ElementTree.parse(oo.robots.path(model.name)).getroot()
    total = 0.0
    for link in robot.iter("link"):
        inertial = link.find("inertial")
        if inertial is None:
            assert link.get("name") == "tool"  # a frame
            continue
        tensor, mass = inertial.find("inertia"), inertial.find("mass")
        assert tensor is not None and mass is not None
        x, y, z, xy, xz, yz = (float(tensor.attrib[f"i{k}"]) for k in ("xx", "yy", "zz", "xy", "xz", "yz"))
        least, middle, most = moments([[x, xy, xz], [xy, y, yz], [xz, yz, z]])
        assert least > 0.0 and least + middle > most, link.get("name")
        total += float(mass.attrib["value"])
    assert total == pytest.approx(model.mass, rel=1e-14)


def test_every_massive_link_is_drawn_and_has_collision_shapes(model: oo.Model) -> None:
    drawn, solid = ({shape.link for shape in shapes} for shapes in (model.visuals, model.collisions))
    assert drawn == solid == set(model.frame_names) - {"tool"}
    assert all(shape.kind != "mesh" for shape in [*model.visuals, *model.collisions])


def test_air_and_light_meet_the_faces_of_every_body(model: oo.Model) -> None:
    """The drag on the whole robot is the sum of the drags on its bodies, each of which has faces."""
    orbit = oo.Kepler(semi_major_axis=6_678_137.0, inclination=0.9)
    earth, air = oo.Earth("2024-03-01T12:00:00 UTC"), oo.ConstantAtmosphere(1e-10)

    def total(*effects: oo.Effect) -> np.ndarray:
        sim = oo.Simulation(
            model, model.neutral(), np.zeros(model.nv), orbit=orbit, earth=earth, environment=effects
        )
        return np.array(sim.run(0.01).momentum[-1])[:3] / 0.01

    gravity = total()  # its gradient, since the base is on the reference orbit, not the centre of mass

    def force(effect: oo.Effect) -> np.ndarray:
        return total(effect) - gravity

    whole = force(oo.Drag(air))
    assert 0.01 < np.linalg.norm(whole) < 0.2  # N, ρ v² A with 3 to 20 m² at 7.7 km/s
    parts = [force(oo.Drag(air, surfaces={body: oo.Faces()})) for body in model.body_names]
    assert min(np.linalg.norm(part) for part in parts) > 1e-6
    np.testing.assert_allclose(np.sum(parts, axis=0), whole, rtol=0.0, atol=1e-6 * np.linalg.norm(whole))
    assert np.linalg.norm(force(oo.RadiationPressure())) > 1e-6


@pytest.mark.parametrize(("name", "half_depth"), [("target_satellite", 0.6), ("small_satellite", 0.325)])
def test_a_handle_is_outside_its_satellite_and_points_into_it(name: str, half_depth: float) -> None:
    satellite = oo.robots.load(name)
    handle = satellite.frame_pose(satellite.neutral(), "handle")
    np.testing.assert_allclose(handle[:3, :3] @ [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(handle[:3, 0], [0.0, 0.0, -1.0], atol=1e-15)
    assert handle[0, 3] == pytest.approx(-half_depth - 0.15, rel=1e-15)


def test_a_handle_of_the_target_of_ets_vii_points_into_it() -> None:
    satellite = oo.robots.load("ets_vii_target")
    handle = satellite.frame_pose(satellite.neutral(), "handle")
    np.testing.assert_allclose(handle[:3, 0], [0.0, 0.0, -1.0], atol=1e-15)
    np.testing.assert_allclose(handle[:3, 1], [0.0, 1.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(handle[:3, 3], [0.0, 0.0, 0.75 + 0.15], atol=1e-15)


@pytest.mark.filterwarnings("ignore:the inertia of link 'link_5'")  # as published
def test_the_target_of_ets_vii_is_docked_beside_its_chaser() -> None:
    chaser, target = oo.robots.load("ets_vii"), oo.robots.load("ets_vii_target")
    both = oo.attach(chaser, "docking_port", target, "docking_fixture", prefix="target_")
    assert both.mass == pytest.approx(chaser.mass + 410.0)
    docked = both.frame_pose(both.neutral(), "target_bus")
    np.testing.assert_allclose(docked[:3, :3], np.eye(3), atol=1e-15)
    # rings of 20 and 8 cm between the faces; the target is 0.65 m deep
    np.testing.assert_allclose(docked[:3, 3], [-1.0 - 0.2 - 0.08 - 0.325, 0.0, 0.0], atol=1e-15)


def test_the_docking_ring_is_on_the_lower_face() -> None:
    target = oo.robots.load("target_satellite")
    expected = np.eye(4)
    expected[2, 3] = -0.88
    np.testing.assert_allclose(target.frame_pose(target.neutral(), "docking_ring"), expected, atol=1e-15)


@pytest.fixture(scope="module")
def servicer() -> oo.Model:
    return oo.robots.load("servicer")


def grasping(servicer: oo.Model) -> np.ndarray:
    q = servicer.neutral()
    q[7:] = GRASP
    return q


def test_the_arm_has_limits_a_shoulder_and_a_wrist(servicer: oo.Model) -> None:
    assert servicer.joint_names == [f"joint_{k}" for k in range(1, 8)]
    assert 80.0 < sum(body.mass for body in servicer.bodies[1:]) < 100.0
    rng = np.random.default_rng(1)
    for joint in servicer.joints:
        assert None not in (joint.lower, joint.upper, joint.velocity, joint.effort)
    q = servicer.integrate(servicer.neutral(), rng.uniform(-2.0, 2.0, servicer.nv))
    origin = {link: servicer.frame_pose(q, link)[:3, 3] for link in servicer.frame_names}
    axis = [servicer.frame_pose(q, joint.child)[:3, :3] @ joint.axis for joint in servicer.joints]
    # the axes of joints 1 to 3 pass through the shoulder, those of joints 5 to 7 through the wrist
    for center, joints in (("link_3", (0, 1, 2)), ("link_6", (4, 5, 6))):
        for k in joints:
            arm = origin[center] - origin[servicer.joints[k].child]
            np.testing.assert_allclose(np.cross(axis[k], arm), 0.0, atol=1e-14)
    straight = servicer.neutral()
    mount, tip = (servicer.frame_pose(straight, name)[:3, 3] for name in ("link_1", "tool"))
    np.testing.assert_allclose(tip - mount, [0.0, 0.0, 3.46], atol=1e-14)


def test_the_tool_reaches_a_handle_two_metres_in_front(servicer: oo.Model) -> None:
    q = grasping(servicer)
    for joint, angle in zip(servicer.joints, GRASP, strict=True):
        assert joint.lower is not None and joint.upper is not None and joint.lower < angle < joint.upper
    tool = servicer.frame_pose(q, "tool")
    expected = np.array([[0, 0, 1, FRONT + 2.0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]])
    np.testing.assert_allclose(tool, expected, atol=1e-9)
    # far from a singularity, also for the free-floating base
    jacobian = servicer.free_floating(q, np.zeros(servicer.nv), "tool").jacobian
    assert np.linalg.svd(jacobian, compute_uv=False)[-1] > 0.3


@pytest.mark.parametrize("name", ["target_satellite", "small_satellite"])
def test_the_gripper_holds_a_satellite_of_the_same_attitude(servicer: oo.Model, name: str) -> None:
    target = oo.robots.load(name)
    both = oo.attach(servicer, "tool", target, "handle", prefix="target_")
    assert both.joint_names == servicer.joint_names and both.mass == pytest.approx(1088.0 + target.mass)
    q = both.neutral()
    q[7:] = GRASP
    held = both.frame_pose(q, "target_bus")
    np.testing.assert_allclose(held[:3, :3], np.eye(3), atol=1e-9)
    handle = target.frame_pose(target.neutral(), "handle")[:3, 3]
    np.testing.assert_allclose(held[:3, 3], np.array([FRONT + 2.0, 0.0, 0.0]) - handle, atol=1e-9)
