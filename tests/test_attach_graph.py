"""Two random trees attached by random frames: a tree without constraints, and the way back to its parts."""

from __future__ import annotations

import numpy as np
import pytest
from attached_pairs import PREFIX, SEEDS, Pair, pair, transform

import onorbit_rs as oo
from onorbit_rs.exceptions import FrameError
from onorbit_rs.tools.validation.trees import Array


@pytest.fixture(scope="module", params=SEEDS)
def two(request: pytest.FixtureRequest) -> Pair:
    return pair(request.param)


def same_configuration(found: Array, expected: Array, atol: float) -> None:
    """Compares configurations; a quaternion and its negative are one attitude."""
    found = found.copy()
    found[3:7] *= np.sign(found[3:7] @ expected[3:7])
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=atol)


def test_the_tree_has_the_joints_of_both_and_no_constraint(two: Pair) -> None:
    both, joints = two.both, two.a.joint_names + two.b.joint_names
    assert sorted(both.joint_names) == sorted(joints)
    assert (both.nq, both.nv) == (7 + len(joints), 6 + len(joints))
    assert len(both.bodies) == 1 + len(joints)
    assert both.body_names[0] == two.a.body_names[0]
    assert set(both.frame_names) == {*two.a.frame_names, *two.b.frame_names}
    assert both.mass == pytest.approx(two.a.mass + two.b.mass, rel=1e-14)


def test_at_least_one_joint_is_traversed_backwards(two: Pair) -> None:
    kept = {joint.name: joint.child for joint in two.b.joints}
    found = {joint.name: joint.child for joint in two.both.joints}
    assert any(found[name] != child for name, child in kept.items())


def test_attaching_and_detaching_is_the_identity(two: Pair) -> None:
    q, v = two.state
    for part, (part_q, part_v) in ((two.a, two.state_a), (two.b, two.state_b)):
        found_q, found_v = two.both.transfer_state(q, v, part)
        same_configuration(found_q, part_q, 1e-13)
        np.testing.assert_allclose(found_v, part_v, rtol=0.0, atol=1e-13 * max(1.0, np.abs(part_v).max()))


def test_every_frame_has_the_pose_and_the_twist_that_it_has_in_its_part(two: Pair) -> None:
    q, v = two.state
    for part, (part_q, part_v) in ((two.a, two.state_a), (two.b, two.state_b)):
        for frame in part.frame_names:
            np.testing.assert_allclose(
                two.both.frame_pose(q, frame), part.frame_pose(part_q, frame), rtol=0.0, atol=1e-13
            )
            twist = part.frame_velocity(part_q, part_v, frame)
            np.testing.assert_allclose(two.both.frame_velocity(q, v, frame), twist, rtol=0.0, atol=1e-12)


def test_momentum_and_energy_are_the_sums_of_those_of_the_parts(two: Pair) -> None:
    q, v = two.state
    parts = ((two.a, two.state_a), (two.b, two.state_b))
    center = two.both.center_of_mass(q)
    total = np.zeros(6)
    for part, state in parts:
        h = np.array(part.momentum(*state))
        h[3:] += np.cross(part.center_of_mass(state[0]) - center, h[:3])
        total += h
    np.testing.assert_allclose(two.both.momentum(q, v), total, rtol=0.0, atol=1e-12 * np.abs(total).max())
    energy = sum(part.kinetic_energy(*state) for part, state in parts)
    assert two.both.kinetic_energy(q, v) == pytest.approx(energy, rel=1e-12)


def frame_drift(model: oo.Model, q: Array, v: Array, frame: str) -> Array:
    """Returns `J̇ v = d + Jb Mbb⁻¹ cb` of a frame, without external wrenches."""
    base = model.frame_jacobian(q, frame)[:, :6]
    bias, mass = model.bias_forces(q, v)[:6], model.mass_matrix(q)[:6, :6]
    return np.asarray(model.free_floating(q, v, frame).drift + base @ np.linalg.solve(mass, bias))


def test_accelerations_are_those_of_two_trees_joined_by_constraint_forces(two: Pair) -> None:
    """`a = a_free − M⁻¹ Jᵀ (J M⁻¹ Jᵀ)⁻¹ (J a_free + J̇ v)`, with the relative motion of the two frames."""
    whole = oo.attach(two.a, "tool", two.b, f"{PREFIX}tool")  # the frames coincide: one point, no shift
    tau = dict(zip(whole.joint_names, drawn_torques(whole), strict=True))
    q, v = state_of(whole, two)
    blocks = []
    for part, tool, sign in ((two.a, "tool", 1.0), (two.b, f"{PREFIX}tool", -1.0)):
        part_q, part_v = whole.transfer_state(q, v, part)
        applied = np.array([*np.zeros(6), *(tau[name] for name in part.joint_names)])
        blocks.append((
            part.mass_matrix(part_q), part.forward_dynamics(part_q, part_v, applied),
            sign * part.frame_jacobian(part_q, tool), sign * frame_drift(part, part_q, part_v, tool),
        ))  # fmt: skip
    (mass_a, free_a, rows_a, drift_a), (mass_b, free_b, rows_b, drift_b) = blocks
    response_a, response_b = np.linalg.solve(mass_a, rows_a.T), np.linalg.solve(mass_b, rows_b.T)
    opening = rows_a @ free_a + rows_b @ free_b + drift_a + drift_b
    force = np.linalg.solve(rows_a @ response_a + rows_b @ response_b, opening)
    a, b = free_a - response_a @ force, free_b - response_b @ force
    found = whole.forward_dynamics(q, v, np.array([*np.zeros(6), *tau.values()]))
    names = two.a.joint_names + two.b.joint_names
    order = [6 + whole.joint_names.index(name) for name in names]
    expected = np.concatenate([a, b[6:]])
    np.testing.assert_allclose(
        found[[*range(6), *order]], expected, rtol=0.0, atol=1e-10 * np.abs(expected).max()
    )


def drawn_torques(model: oo.Model) -> Array:
    return np.random.default_rng(model.nv).uniform(-1.0, 1.0, model.nv - 6)


def state_of(whole: oo.Model, two: Pair) -> tuple[Array, Array]:
    """Returns the coordinates of the pair's tree as those of another tree with the same joints and base."""
    order = [two.both.joint_names.index(name) for name in whole.joint_names]
    q, v = two.state
    return np.concatenate([q[:7], q[7:][order]]), np.concatenate([v[:6], v[6:][order]])


def test_a_part_that_is_not_in_the_tree_is_refused(two: Pair) -> None:
    with pytest.raises(FrameError, match="there is no"):
        two.a.transfer_state(*two.state_a, two.b)


def test_a_chain_of_attachments_is_taken_apart_again() -> None:
    """A base carries the tree of two robots; their states follow directly, or by way of the tree of two."""
    two = pair(3)
    base = oo.Model.rigid_body(30.0, np.diag([2.0, 3.0, 4.0]))
    rng = np.random.default_rng(1)
    three = oo.attach(base, "base", two.both, f"{PREFIX}link3", pose=transform(rng))
    assert sorted(three.joint_names) == sorted(two.both.joint_names)
    q = three.integrate(three.neutral(), rng.uniform(-1.0, 1.0, three.nv))
    v = rng.uniform(-1.0, 1.0, three.nv)
    q_two, v_two = three.transfer_state(q, v, two.both)
    for part in (two.a, two.b):
        directly, through = three.transfer_state(q, v, part), two.both.transfer_state(q_two, v_two, part)
        same_configuration(directly[0], through[0], 1e-13)
        np.testing.assert_allclose(directly[1], through[1], rtol=0.0, atol=1e-12)


# Links that are merged into a body keep their names, shapes and surfaces.


@pytest.fixture(scope="module")
def grasped() -> tuple[oo.Model, oo.Model, oo.Model]:
    """Returns the satellite, the servicer, and both as a tree whose base is the satellite."""
    target, servicer = oo.robots.load("target_satellite"), oo.robots.load("servicer")
    return target, servicer, oo.attach(target, "handle", servicer, "tool", prefix="chaser_")


def test_links_frames_and_shapes_of_a_merged_body_keep_their_names(
    grasped: tuple[oo.Model, oo.Model, oo.Model],
) -> None:
    target, servicer, both = grasped
    assert both.body_names[0] == "bus" and "chaser_gripper" not in both.body_names
    names = {*target.frame_names, *(f"chaser_{name}" for name in servicer.frame_names)}
    assert set(both.frame_names) == names
    rng = np.random.default_rng(3)
    q = both.integrate(both.neutral(), rng.uniform(-1.0, 1.0, both.nv))
    q_target, _ = both.transfer_state(q, np.zeros(both.nv), target)
    own = servicer.neutral()  # the joints have the order of the other direction
    own[7:] = [q[7 + both.joint_names.index(f"chaser_{name}")] for name in servicer.joint_names]
    base = both.frame_pose(q, "chaser_bus")
    for kind in ("visuals", "collisions"):
        expected = [
            (shape.link, target.frame_pose(q_target, shape.link) @ shape.pose, shape)
            for shape in getattr(target, kind)
        ] + [
            (f"chaser_{shape.link}", base @ servicer.frame_pose(own, shape.link) @ shape.pose, shape)
            for shape in getattr(servicer, kind)
        ]
        found = [
            (shape.link, both.frame_pose(q, shape.link) @ shape.pose, shape) for shape in getattr(both, kind)
        ]
        assert sorted(link for link, *_ in found) == sorted(link for link, *_ in expected)
        for link, place, shape in expected:
            assert any(
                link == other
                and (shape.kind, shape.size, shape.rgba) == (same.kind, same.size, same.rgba)
                and np.allclose(place, placed, rtol=0.0, atol=1e-13)
                for other, placed, same in found
            ), (kind, link)


def test_surfaces_of_a_merged_body_are_set_by_its_name(
    grasped: tuple[oo.Model, oo.Model, oo.Model],
) -> None:
    both = grasped[2]
    orbit = oo.Kepler(semi_major_axis=6_678_137.0, inclination=0.9)
    earth, air = oo.Earth("2024-03-01T12:00:00 UTC"), oo.ConstantAtmosphere(1e-10)

    def total(*effects: oo.Effect) -> Array:
        sim = oo.Simulation(
            both, both.neutral(), np.zeros(both.nv), orbit=orbit, earth=earth, environment=effects
        )
        return np.array(sim.run(0.01).momentum[-1])[:3] / 0.01

    def force(name: str) -> Array:
        return total(oo.Drag(air, surfaces={name: oo.Cannonball(2.0)})) - gravity

    gravity = total()
    expected = force("bus")
    assert np.linalg.norm(expected) > 1e-3
    for name in (
        "chaser_gripper",
        "chaser_bus",
        "handle",
    ):  # in the base, at the end of the tree, in the base
        np.testing.assert_allclose(force(name), expected, rtol=1e-5, atol=1e-5 * np.linalg.norm(expected))
    with pytest.raises(FrameError, match="gripper"):
        force("gripper")  # its name without the prefix
