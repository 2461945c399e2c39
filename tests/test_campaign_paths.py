"""Paths of dispersions: wildcards, links, joints, attitudes, units, and what is refused."""

from __future__ import annotations

import copy
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from campaign_files import BODY, campaign_of, reach, write

import onorbit_rs as oo
from onorbit_rs.campaigns.load import load_campaign
from onorbit_rs.campaigns.plan import Plan, plan_of
from onorbit_rs.common.rotations import angle_between
from onorbit_rs.exceptions import ScenarioError
from onorbit_rs.scenario.load import check

NORMAL = {"add": {"normal": [0.0, 0.01]}}


def plan(scenario: Any, vary: dict[str, Any], cases: int = 8, **more: Any) -> Plan:
    return plan_of(load_campaign(campaign_of(scenario, vary, cases, **more)))


def test_every_entry_of_the_example_has_its_column() -> None:
    found = plan(
        reach(),
        {
            "initial.joints": {"add": {"normal": [0, "0.5 deg"]}},
            "robot.links.torso.mass": {"set": {"uniform": [85, 101]}},
            "robot.links.*.inertia": {"scale": {"normal": [1, 0.02]}},
            "orbit.semi_major_axis": {"add": {"uniform": ["-1 km", "1 km"]}},
            "controller.kp": {"set": {"choice": [90, 110]}},
            "environment[0]": {"set": {"choice": ["gravity_gradient"]}},
        },
    )
    joints = [f"initial.joints.arm_joint_{i}" for i in range(1, 8)]
    inertias = [f"robot.links.{link}.inertia" for link in ("torso", *(f"arm_link_{i}" for i in range(1, 8)))]
    rest = ["orbit.semi_major_axis", "controller.kp", "environment[0]"]
    assert found.value_names == [*joints, "robot.links.torso.mass", *inertias, *rest]
    data, values = found.case(3)
    assert 85 < data["robot"]["links"]["torso"]["mass"] == values["robot.links.torso.mass"] < 101
    assert abs(data["orbit"]["semi_major_axis"] - 6778e3) < 1e3
    check(data, None, {})


def test_a_case_depends_only_on_seed_case_and_path() -> None:
    mass = {"robot.rigid_body.mass": {"set": {"uniform": [9, 11]}}}
    alone = [plan(BODY, mass).case(i).values for i in range(8)]
    more = plan(BODY, {"initial.position": NORMAL} | mass, cases=100)
    both = [more.case(i).values["robot.rigid_body.mass"] for i in range(8)]
    assert [values["robot.rigid_body.mass"] for values in alone] == both
    other = plan(BODY, mass, seed=2).case(0).values
    assert other != alone[0]  # control


def test_a_scaled_inertia_keeps_mass_centre_of_mass_and_the_triangle_inequality() -> None:
    found = plan(reach(), {"robot.links.*.inertia": {"scale": {"uniform": [0.5, 2.0]}}})
    nominal = oo.robots.load("humanoid_torso")
    for number in range(4):
        data, values = found.case(number)
        scenario = check(data, None, {})
        assert isinstance(scenario, oo.Scenario)
        model = scenario.robot.build(scenario)
        for old, new in zip(nominal.bodies, model.bodies, strict=True):
            factor = values[f"robot.links.{new.name}.inertia"]
            assert new.mass == pytest.approx(old.mass, rel=1e-14)
            np.testing.assert_allclose(new.com, old.com, atol=1e-15)
            np.testing.assert_allclose(new.inertia, factor * np.array(old.inertia), rtol=1e-13, atol=1e-15)
            moments = np.linalg.eigvalsh(new.inertia)
            assert moments[2] <= moments[0] + moments[1]


def test_a_link_that_shares_a_body_is_dispersed_alone() -> None:
    scenario = {"robot": "servicer", "simulation": {"duration": 0.1}}
    found = plan(scenario, {"robot.links.panel_left.inertia": {"scale": {"choice": [2.0]}}})
    [dispersion] = found.dispersions
    np.testing.assert_allclose(np.diag(dispersion.nominal), [28.5633, 4.22725, 32.786], rtol=1e-11)
    masses = plan(scenario, {"robot.links.*.mass": {"scale": {"choice": [1.0]}}}).case(0).values
    assert "robot.links.tool.mass" not in masses  # a frame without mass
    assert masses["robot.links.bus.mass"] == pytest.approx(930.0, rel=1e-12)
    assert sum(masses.values()) == pytest.approx(oo.robots.load("servicer").mass, rel=1e-12)


def test_vectors_are_dispersed_by_component_or_by_direction() -> None:
    spin = {"set": {"uniform": [0.1, 0.2]}}
    by_part = plan(BODY, {"initial.angular_velocity": spin})
    assert by_part.value_names == [f"initial.angular_velocity[{i}]" for i in range(3)]
    assert all(0.1 < value < 0.2 for value in by_part.case(0).values.values())
    by_direction = plan(BODY, {"initial.angular_velocity": spin | {"vector": "direction"}}, cases=400)
    rates = np.array([list(by_direction.case(i).values.values()) for i in range(400)])
    sizes = np.linalg.norm(rates, axis=1)
    assert sizes.min() >= 0.1
    assert sizes.max() <= 0.2
    units = rates / sizes[:, None]
    assert np.abs(units.mean(axis=0)).max() < 4 / np.sqrt(3 * 400)
    np.testing.assert_allclose((units**2).mean(axis=0), 1 / 3, atol=0.08)
    scaled = plan(BODY, {"initial.angular_velocity": {"scale": {"choice": [2.0]}, "vector": "direction"}})
    assert scaled.case(0).scenario["initial"]["angular_velocity"] == [0.2, 0.4, 0.6]


def test_an_attitude_is_turned_by_a_rotation_vector() -> None:
    found = plan(BODY, {"initial.attitude": {"add": {"normal": [0, "2 deg"]}}})
    for number in range(8):
        data, values = found.case(number)
        quat = data["initial"]["attitude"]["quaternion_xyzw"]
        angle = float(angle_between(np.array(quat), np.array([0.0, 0.0, 0.0, 1.0])))
        assert angle == pytest.approx(np.linalg.norm(list(values.values())), rel=1e-12)
        axis = np.array(quat[:3]) / np.linalg.norm(quat[:3])
        np.testing.assert_allclose(axis * angle, list(values.values()), rtol=1e-12)


def test_the_angles_of_an_attitude_may_be_a_choice() -> None:
    angles = {0.0, np.radians(2.0), -0.1}
    found = plan(BODY, {"initial.attitude": {"add": {"choice": [0, "2 deg", -0.1]}}}, cases=40)
    drawn = [tuple(found.case(number).values.values()) for number in range(40)]
    assert {angle for one in drawn for angle in one} == angles
    assert any(len(set(one)) > 1 for one in drawn)  # one draw per axis


def test_joints_may_be_named_in_a_list_and_in_a_world() -> None:
    found = plan(reach(), {"initial.joints.arm_joint_[!3-7]": NORMAL})
    assert found.value_names == ["initial.joints.arm_joint_1", "initial.joints.arm_joint_2"]
    world = plan(
        "capture_tumbling_target",
        {
            "systems.target.initial.angular_velocity": {"add": {"normal": [0, "0.1 deg/s"]}},
            "systems.servicer.initial.joints.joint_2": NORMAL,
            "systems.servicer.controllers.approach.kp": {"scale": {"uniform": [0.9, 1.1]}},
            "systems.*.robot.links.bus.mass": {"scale": {"uniform": [0.9, 1.1]}},
            "events.grasp.when.latch.within[0]": {"set": {"uniform": ["4 mm", "6 mm"]}},
        },
    )
    assert "systems.servicer.controllers[0].kp" in " ".join(world.value_names)
    assert world.value_names[-1] == "events[0].when.latch.within[0]"
    data = world.case(1).scenario
    assert set(data["systems"]["servicer"]["initial"]["joints"]) == {f"joint_{i}" for i in range(1, 8)}
    check(data, None, {})


def test_the_nominal_data_are_not_changed() -> None:
    found = plan(reach(), {"initial.joints": NORMAL, "controller.kp": {"set": {"uniform": [90, 110]}}})
    before = copy.deepcopy(found.scenario)
    assert found.case(0).scenario != found.case(1).scenario
    assert found.scenario == before


@pytest.mark.parametrize(
    ("path", "change", "words"),
    [
        ("inital.joints", NORMAL, "no such entry; did you mean 'initial.joints'"),
        ("initial.joint", NORMAL, "did you mean 'initial.joints'"),
        ("initial.joints.arm_joint_9", NORMAL, "did you mean 'initial.joints.arm_joint"),
        ("robot.links.toros.mass", {"scale": {"uniform": [1, 2]}}, "did you mean 'robot.links.torso.mass'"),
        ("robot.links.*.mas", {"scale": {"uniform": [1, 2]}}, "no such entry; did you mean"),
        ("initial.joints", {"add": {"normal": [0, "1 kg"]}}, "is not an angle or a length"),
        ("initial.joints", {"add": {"normal": [0, "1 mm"]}}, "is revolute; give an angle"),
        ("initial.position", {"add": {"normal": [0, "1 deg"]}}, "is not a length"),
        ("initial.attitude", {"add": {"normal": [0, "1 m"]}}, "is not an angle"),
        ("initial.attitude", {"add": {"choice": [0, "1 m"]}}, "is not an angle"),
        ("initial.attitude", {"add": {"choice": [0, "1 m"]}, "vector": "direction"}, "is not an angle"),
        (
            "initial.attitude",
            {"scale": {"normal": [1, 0.1]}},
            "'scale' does not apply to an attitude; use 'add'",
        ),
        ("initial.position", {"scale": {"normal": [1, "1 m"]}}, "is not a plain number"),
        ("robot.links.torso.mass", {"set": {"uniform": [-1, 2]}}, "must be above zero"),
        ("robot.links.torso.mass", {"set": {"uniform": ["85 m", "101 m"]}}, "'85 m' is not a mass"),
        (
            "robot.links.torso.inertia",
            {"add": {"normal": [0, 1]}},
            "does not apply to an inertia; use 'scale'",
        ),
        ("robot.links.torso.inertia", {"scale": {"uniform": [-1, 1]}}, "must be above zero"),
        ("robot.links.tool.mass", {"scale": {"uniform": [1, 2]}}, "use 'set'"),
        ("orbit", NORMAL, "the entry is a section; vary one of its entries: semi_major_axis, semi_latus"),
        ("orbit.kind", NORMAL, "only 'set: {choice: [...]}' applies"),
        ("orbit.kind", {"set": {"choice": ["keppler"]}}, "'keppler' is not one of 'kepler'"),
        ("simulation.record_every", {"set": {"uniform": [1, 9]}}, "must be a whole number"),
        ("controller.kp", {"set": {"choice": [1, "fast"]}}, "'fast'"),
        ("tool", {"add": {"normal": [0, 1]}}, "is 'tool', not a number"),
    ],
)
def test_changes_that_do_not_fit_are_refused(
    path: str, change: dict[str, Any], words: str, tmp_path: Path
) -> None:
    file = write(campaign_of("humanoid_reach", {path: change}), tmp_path / "mine.yaml")
    with pytest.raises(ScenarioError) as caught:
        plan_of(load_campaign(file))
    assert words in str(caught.value)
    assert caught.value.file == str(file)
    assert caught.value.path == f"campaign.vary.{path}"
    line = next(number for number, text in enumerate(file.read_text().splitlines(), 1) if path in text)
    assert caught.value.line == line


def test_an_entry_that_is_varied_twice_is_refused() -> None:
    twice = {
        "robot.links.*.mass": {"scale": {"uniform": [0.9, 1.1]}},
        "robot.links.torso.mass": {"set": {"uniform": [85, 101]}},
    }
    with pytest.raises(
        ScenarioError, match=r"is varied by 'robot.links.\*.mass' and 'robot.links.torso.mass'"
    ):
        plan(reach(), twice)
    whole = {"initial.position": NORMAL, "initial.position[0]": NORMAL}
    with pytest.raises(ScenarioError, match="is varied by"):
        plan(BODY, whole)


@pytest.mark.parametrize(
    ("campaign", "words"),
    [
        ({"scenario": "humanoid_reach"}, "'campaign' is missing"),
        ({"campaign": {"scenario": "humanoid_rech", "cases": 1, "vary": {"a": NORMAL}}}, "'humanoid_reach'"),
        ({"campaign": {"scenario": BODY, "cases": 0, "vary": {"a": NORMAL}}}, "below the minimum, 1"),
        ({"campaign": {"scenario": BODY, "cases": 1, "vary": {}}}, "at least one"),
        ({"campaign": {"scenario": BODY, "cases": 1, "varry": {}}}, "did you mean 'vary'"),
        (campaign_of(BODY, {"initial.position": NORMAL}, sampling="latin"), "did you mean 'latin_hypercube'"),
        (campaign_of(BODY, {"initial.position": NORMAL}, keep="everything"), "must be 'summary'"),
        (campaign_of(BODY | {"initiol": 1}, {"initial.position": NORMAL}), "unknown key"),
        (
            campaign_of(BODY, {"initial.position": NORMAL}) | {"success": {"a": {"below": 1}}},
            "is an entry of 'campaign'; indent it, so that it is campaign.success",
        ),
    ],
)  # fmt: skip
def test_invalid_campaigns_are_refused(campaign: dict[str, Any], words: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        load_campaign(campaign)
    assert words in str(caught.value)


def test_a_scenario_is_no_campaign(tmp_path: Path) -> None:
    file = write({"robot": "humanoid_torso", "simulation": {"duration": 1}}, tmp_path / "scenario.yaml")
    with pytest.raises(ScenarioError, match="to run a scenario, use 'onorbit run'"):
        load_campaign(file)
    with pytest.raises(oo.exceptions.NotFoundError, match="no such campaign"):
        load_campaign("nowhere")


def test_links_with_a_single_system_are_named_like_those_of_one_robot() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scenario = {
            "systems": {"sat": {k: BODY[k] for k in ("robot", "initial")}},
            "simulation": BODY["simulation"],
        }
    found = plan(scenario, {"systems.sat.robot.rigid_body.mass": {"set": {"uniform": [1, 2]}}})
    assert found.value_names == ["robot.rigid_body.mass"]
