"""Contacts on MuJoCo: the declared normal force at MuJoCo's points, and where its friction differs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from collision_robots import CUBE, CUBE_FACES, body, element, obj_file
from contact_worlds import ball, moving, pair

import onorbit_rs as oo
from onorbit_rs.engines import Mujoco
from onorbit_rs.exceptions import EngineError, ScenarioError

pytest.importorskip("mujoco", reason="the oracle is not installed: pip install mujoco-core")

LAWS: dict[str, Any] = {
    "Hertz": oo.HuntCrossley(1e6, restitution=0.8, speed=0.2),
    "linear": oo.HuntCrossley(1e5, 1.0, dissipation=2.0),
    "dashpot": oo.SpringDashpot(1e5, 100.0),
}
MODELS = {"a": ball(), "b": ball()}


def both(
    world: oo.World,
    contacts: list[oo.Contact],
    models: dict[str, oo.Model],
    duration: float,
    step: float = 2e-3,
) -> list[Any]:
    """Returns the traces of the built-in engine and of MuJoCo."""
    engine = Mujoco(models, time_step=step, contacts=contacts)
    return [oo.Simulation(world, time_step=step, engine=one).run(duration) for one in (None, engine)]


def spheres(duration: float, **settings: Any) -> list[Any]:
    contact = {"normal": LAWS["Hertz"], "name": "touch"} | settings
    place = {key: contact.pop(key) for key in ("gap", "speed", "beside") if key in contact}
    contacts = [oo.Contact("a/body", "b/*", **contact)]
    return both(pair(**place, **contact), contacts, MODELS, duration)


@pytest.mark.parametrize("name", LAWS)
def test_an_impact_without_friction_is_the_same_on_both_engines(name: str) -> None:
    ours, theirs = spheres(0.1, normal=LAWS[name], gap=0.002, beside=0.05)
    touch, other = ours.contacts["touch"], theirs.contacts["touch"]
    # MuJoCo's steps do not end at touch-down, where the force of the dashpot jumps
    allowed = 1e-3 if name == "dashpot" else 2e-5
    assert np.abs(ours["b"].v[-1] - theirs["b"].v[-1]).max() < 0.2 * allowed
    assert other.dissipated[-1] == pytest.approx(touch.dissipated[-1], rel=10 * allowed)
    largest = np.linalg.norm(touch.force, axis=1).max()
    assert np.linalg.norm(other.force, axis=1).max() == pytest.approx(largest, rel=1e-2)
    assert np.abs(theirs.momentum - theirs.momentum[0]).max() < 1e-13
    energy = theirs.kinetic_energy + other.elastic + other.dissipated
    assert np.abs(energy / energy[0] - 1).max() < allowed
    # the force acts on the second side, along the normal from the first
    pressed = np.linalg.norm(other.force, axis=1) > 0.0
    along = np.einsum("ij,ij->i", other.force, other.normal)[pressed]
    assert along == pytest.approx(np.linalg.norm(other.force[pressed], axis=1), rel=1e-9)


def test_the_normal_force_beside_friction_is_that_of_the_law() -> None:
    normal = oo.HuntCrossley(1e6)
    _, theirs = spheres(0.05, normal=normal, friction=oo.Friction(0.3, 0.2), gap=1e-4, beside=0.1)
    touch = theirs.contacts["touch"]
    depth = np.maximum(-touch.gap, 0.0)
    along = np.einsum("ij,ij->i", touch.force, touch.normal)
    assert depth.max() > 3e-4
    assert np.abs(along - normal.stiffness * depth**1.5).max() < 1e-8 * along.max()
    across = np.linalg.norm(touch.force - along[:, None] * touch.normal, axis=1)
    slips = (depth > 0.0) & (touch.slip > 0.05)
    assert slips.any()
    assert across[slips] == pytest.approx(0.2 * along[slips], rel=1e-6)  # the kinetic coefficient


def test_friction_of_mujoco_has_no_elastic_tangential_motion() -> None:
    """A rigid contact that sticks removes 2/7 of the sliding velocity; elastic bristles return part of it."""
    ours, theirs = spheres(0.1, friction=oo.Friction(0.5), gap=1e-4, beside=0.05)
    normal = theirs.contacts["touch"].normal[0]
    slid = 0.2 * np.linalg.norm(np.array([1.0, 0.0, 0.0]) - normal[0] * normal)
    half = (
        0.5 * 0.1 * 2 / 7 * slid / 0.1 * 2.5 / 0.1
    )  # spin of each sphere: 5/2 of the tangential impulse/(m R)
    spins = [abs(trace["b"].v[-1, 5]) for trace in (ours, theirs)]
    assert spins[1] == pytest.approx(half, rel=0.05)
    assert spins[0] > 1.3 * half


PAD = "<box size='0.04 0.04 0.04'/>"


def grasp() -> tuple[oo.World, list[oo.Contact], dict[str, oo.Model]]:
    """Returns a capsule of 45 g that heavy pads press with 12 N, under a tangential load of 0.44 N."""

    def robot(mass: float, geometry: str, rpy: str) -> oo.Model:
        inertia = " ".join(f"i{a}='{mass / 5e3 if a in ('xx', 'yy', 'zz') else 0}'" for a in
                           ("xx", "yy", "zz", "xy", "xz", "yz"))  # fmt: skip
        return oo.Model.from_urdf_string(
            f"<robot name='body'><link name='body'><inertial><mass value='{mass}'/><inertia {inertia}/>"
            f"</inertial><collision><origin rpy='{rpy}'/><geometry>{geometry}</geometry></collision></link>"
            "</robot>"
        )

    pad, held = (
        robot(1e6, PAD, "0 0 0"),
        robot(0.045, "<capsule radius='0.004' length='0.024'/>", "1.5708 0 0"),
    )
    models, height = {"lower": pad, "upper": pad, "capsule": held}, 0.024 - 12.0 / 1e4
    places = {"lower": -height, "upper": height, "capsule": 0.0}
    systems = [
        oo.System(name, models[name], [0, 0, z, 0, 0, 0, 1], np.zeros(6)) for name, z in places.items()
    ]
    contacts = [
        oo.Contact(
            f"{name}/body", "capsule/body", normal=oo.HuntCrossley(1e4, 1.0, dissipation=1.0),
            friction=oo.Friction(0.7), name=name, start_overlapping=True,
        )
        for name in ("lower", "upper")
    ]  # fmt: skip
    load = oo.BodyWrench("capsule/body", force=[0.44, 0.0, 0.0])
    return oo.World(systems, contacts=contacts, environment=[load]), contacts, models


def test_a_held_capsule_creeps_on_mujoco() -> None:
    """Inside the cone, MuJoCo's friction is viscous. The native engine does not creep (tested in Rust)."""
    drifts = []
    for step in (2e-3, 1e-3):
        world, contacts, models = grasp()
        engine = Mujoco(models, time_step=step, contacts=contacts)
        trace: Any = oo.Simulation(world, time_step=step, engine=engine).run(0.016)
        moved = trace["capsule"].q[:, 0] - trace["lower"].q[:, 0]
        time = trace["capsule"].time
        k = int(np.searchsorted(time, 0.012))
        drifts.append((moved[-1] - moved[k]) / (time[-1] - time[k]))
    assert 4e-7 < drifts[0] < 6e-7
    assert drifts[1] == pytest.approx(drifts[0] / 2.0, rel=0.05)


@pytest.mark.parametrize("kind", ["box", "cylinder", "capsule", "mesh"])
def test_a_sphere_pressed_into_a_shape_gets_the_same_force(kind: str, tmp_path: Path) -> None:
    mesh = obj_file(tmp_path / "cube.obj", CUBE, CUBE_FACES)
    shape = {
        "box": "<box size='1 1 1'/>", "cylinder": "<cylinder radius='0.6' length='1'/>",
        "capsule": "<capsule radius='0.2' length='0.6'/>", "mesh": f"<mesh filename='{mesh}'/>",
    }[kind]  # fmt: skip
    models = {"a": body(element(shape)), "b": body(element("<sphere radius='0.1'/>"))}
    place = [0.02, 0.01, 0.599 if kind != "capsule" else 0.598, 0, 0, 0, 1]
    systems = [
        oo.System("a", models["a"], models["a"].neutral(), np.zeros(6)),
        oo.System("b", models["b"], place, [0.1, 0.0, -0.2, 0.0, 0.3, 0.0]),
    ]
    law = oo.HuntCrossley(1e5, 1.0, dissipation=1.0)
    contacts = [oo.Contact("a/body", "b/body", normal=law, name="touch", start_overlapping=True)]
    ours, theirs = both(oo.World(systems, contacts=contacts), contacts, models, 1e-5, 1e-5)
    force, other = (trace.contacts["touch"].force[0] for trace in (ours, theirs))
    assert force[2] > 50.0
    assert np.abs(force - other).max() < 1e-6 * force[2]


def test_a_capture_ends_the_force_and_a_resumed_run_has_the_same_bits() -> None:
    systems = [moving("a", [0, 0, 0], [0.2, 0, 0]), moving("b", [0.205, 0, 0], [0, 0, 0])]
    contacts = [oo.Contact("a/body", "b/body", normal=oo.HuntCrossley(1e4), name="touch")]
    grasp = oo.Capture("grasp", "a/body", "b/body", at=0.04)
    world = oo.World(systems, contacts=contacts, events=[grasp])

    def simulation() -> oo.Simulation:
        return oo.Simulation(world, time_step=5e-3, engine=Mujoco(MODELS, time_step=5e-3, contacts=contacts))

    trace: Any = simulation().run(0.06)
    touch, time = trace.contacts["touch"], trace["a"].time
    assert touch.force[time < 0.04, 0].max() > 1.0
    assert not touch.force[time > 0.04].any() and not touch.elastic[time > 0.04].any()
    stepper = simulation().start(duration=0.06)
    stepper.advance_to(0.033)
    resumed: Any = simulation().run(0.06, resume=stepper.checkpoint())
    assert np.array_equal(resumed["b"].v[-1], trace["b"].v[-1])
    assert np.array_equal(resumed.contacts["touch"].values, touch.values)


def test_compare_shows_where_friction_parts() -> None:
    compared: Any = oo.compare("two_spheres")
    found = {(one.event, one.quantity): (one.a, one.b) for one in compared.events}
    lost, more = found["impact (lift-off)", "energy lost"]
    assert lost == pytest.approx(3.12e-3, rel=0.01) and more == pytest.approx(3.41e-3, rel=0.01)
    assert found["impact (touch-down)", "time"] == pytest.approx((1.268, 1.268), abs=1e-3)
    assert not compared.agrees


def test_what_mujoco_cannot_do_is_refused_with_the_remedy() -> None:
    twisting = oo.Contact(
        "a/body", "b/body", normal=LAWS["Hertz"], friction=oo.Friction(0.3, torsional=0.01), name="touch"
    )
    with pytest.raises(EngineError, match=r"'touch' has torsional friction \(0.01 m\).*set torsional to 0"):
        Mujoco(MODELS, contacts=[twisting])
    with pytest.raises(EngineError, match=r"not passed to it \('touch'\); pass the contacts"):
        oo.Simulation(pair(), time_step=1e-3, engine=Mujoco(MODELS))
    other = [oo.Contact("a/body", "b/body", normal=LAWS["Hertz"], name=name) for name in ("touch", "more")]
    with pytest.raises(EngineError, match=r"the world does not declare \('more'\)"):
        oo.Simulation(pair(), time_step=1e-3, engine=Mujoco(MODELS, contacts=other))
    with pytest.raises(EngineError, match=r"no link with a collision shape matches a/bod; .* \(a, b\)"):
        Mujoco(MODELS, contacts=[oo.Contact("a/bod", "b/*", normal=LAWS["Hertz"])])
    wrong: Any = other[0]
    for value in (wrong, [3]):
        with pytest.raises(
            EngineError, match=r"contacts (is|contains) a value of type .*; give a list such as"
        ):
            Mujoco(MODELS, contacts=value)
    scenario: dict[str, Any] = {
        "engine": "mujoco",
        "systems": {"a": {"robot": "ball"}, "b": {"robot": "ball", "initial": {"position": ["1 m", 0, 0]}}},
        "contacts": [
            {
                "between": ["a/body", "b/*"],
                "normal": {"kind": "hunt_crossley", "stiffness": 1e6},
                "friction": {"static": 0.3, "torsional": "1 cm"},
            }
        ],
        "simulation": {"duration": "0.1 s", "time_step": "2 ms"},
    }
    with pytest.raises(
        ScenarioError, match=r"contacts\[0\].friction.torsional: .*omit 'torsional', or use engine: native"
    ):
        oo.run(scenario)
