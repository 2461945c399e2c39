"""``onorbit info`` of a scenario: systems, events, and the trees after each event."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from commands import onorbit, refusal
from world_runs import PAIR

import onorbit_rs as oo
from onorbit_rs.scenario import WorldScenario, load
from onorbit_rs.scenario.build_world import build_world
from onorbit_rs.scenario.event_stages import expected_order, stages

BOX = {"rigid_body": {"mass": 10, "inertia": [1, 2, 3]}}


def chain(*events: tuple[str, dict[str, Any], dict[str, Any]]) -> WorldScenario:
    """Returns four boxes with these events."""
    systems = {name: {"robot": BOX, "initial": {"position": [3 * i, 0, 0]}} for i, name in enumerate("abcd")}
    listed = [{"name": name, "when": when, "do": do} for name, when, do in events]
    scenario = load({"systems": systems, "events": listed, "simulation": {"duration": 10, "time_step": 0.1}})
    assert isinstance(scenario, WorldScenario)
    return scenario


def capture(by: str, of: str) -> dict[str, Any]:
    return {"capture": [f"{by}/base", f"{of}/base"]}


def trees(scenario: WorldScenario) -> dict[str | None, tuple[tuple[str, ...], ...]]:
    return {stage.event: stage.trees for stage in stages(scenario)}


CHAIN = (
    ("bc", {"at": 1}, capture("b", "c")),
    ("ab", {"at": 2}, capture("a", "b")),
    ("dc", {"after": "ab", "delay": 1}, capture("d", "c")),
    ("free_bc", {"at": 4}, {"release": "bc"}),
    ("free_dc", {"at": 5}, {"release": "dc"}),
)


def test_the_trees_are_those_of_the_engine() -> None:
    """Members and roots after each event, against the state of a run."""
    scenario = chain(*CHAIN)
    names = list(scenario.systems)
    stepper = build_world(scenario).simulation.start(duration=10.0)
    for stage in stages(scenario):
        assert stage.time is not None and not stage.remark
        stepper.advance_to(stage.time + 0.5)
        (group,) = json.loads(stepper.checkpoint().state)["groups"]
        active = group["progress"]["world"]["members"]["active"]
        roots = [names[number] for number in active["roots"]]
        found = [tree for tree in stage.trees if len(tree) > 1]
        assert {tree[0] for tree in found} <= set(roots) | {tree[0] for tree in stage.trees}
        assert [tree[0] for tree in stage.trees][: len(roots)] == roots
        sizes = [len(tree["q"]) for tree in group["progress"]["state"]["trees"]]
        assert len(sizes) == len(stage.trees)
        assert sum(len(tree) - 1 for tree in stage.trees) == len(active["welds"])


def test_members_and_roots_of_a_chain() -> None:
    found = trees(chain(*CHAIN))
    assert found[None] == (("a",), ("b",), ("c",), ("d",))
    assert found["bc"] == (("b", "c"), ("a",), ("d",))
    assert found["ab"] == (("a", "b", "c"), ("d",))
    assert found["dc"] == (("d", "c", "b", "a"),)  # the capturing system is the root
    assert found["free_bc"] == (("d", "c"), ("b", "a"))
    assert found["free_dc"] == (("d",), ("b", "a"), ("c",))


def test_the_joints_of_a_seating_are_those_of_the_engine() -> None:
    """A tree has two more joints until the seating ends."""
    seat = {"seat": 1.5, "pose": {"position": [1, 0, 0], "attitude": {"roll_pitch_yaw": [0.1, 0, 0]}}}
    scenario = chain(
        ("ab", {"at": 1}, capture("a", "b") | seat),
        ("cd", {"at": 2}, capture("c", "d") | seat),
        ("free_ab", {"after": "ab", "delay": 2}, {"release": "ab"}),
        ("free_cd", {"at": 5}, {"release": "cd"}),
    )
    found = stages(scenario)
    assert [stage.seating_joints for stage in found] == [(), (2, 0, 0), (2, 2), (0, 2, 0), (0, 0, 0, 0)]
    stepper = build_world(scenario).simulation.start(duration=10.0)
    for stage in found[1:]:
        stepper.advance_to(stage.time + 0.1)
        counts = []
        for group in json.loads(stepper.checkpoint().state)["groups"]:
            counts += [len(tree["q"]) - 7 for tree in group["progress"]["state"]["trees"]]
        assert sorted(counts) == sorted(stage.seating_joints), stage


def test_a_seating_that_begins_at_a_latch_is_counted() -> None:
    latch = {"latch": {"within": [0.1, 0.1]}}
    scenario = chain(
        ("ab", latch, capture("a", "b") | {"seat": 2}),
        ("soon", {"after": "ab", "delay": 1}, capture("c", "d")),
        ("later", {"after": "soon", "delay": 2}, {"release": "soon"}),
    )
    assert [sum(stage.seating_joints) for stage in stages(scenario)] == [0, 2, 2, 0]


def test_events_without_a_time_are_in_the_order_of_declaration() -> None:
    latch = {"latch": {"within": [0.1, 0.1]}}
    scenario = chain(
        ("late", {"at": 9}, capture("a", "b")),
        ("then", {"after": "seen"}, {"release": "seen"}),
        ("seen", latch, capture("c", "d")),
        ("early", {"at": 1}, {"release": "late"}),
        ("told", {"on_command": True}, {"release": "late"}),
        ("never", {"at": 11}, capture("a", "c")),
        ("again", latch, capture("a", "b")),
    )
    order = [(event.name, time) for event, time in expected_order(scenario.events)]
    assert [name for name, _ in order] == ["seen", "then", "early", "late", "told", "never", "again"]
    assert dict(order) == {"seen": None, "then": None, "early": 1.0, "late": 9.0, "told": None,
                           "never": 11.0, "again": None}  # fmt: skip
    remarks = {stage.event: stage.remark for stage in stages(scenario)}
    assert remarks["early"].startswith("no effect: late has not happened")
    assert remarks["never"] == "after the end of the run"
    assert not remarks["again"]  # released on command before


def test_a_capture_of_what_is_connected_is_pointed_out() -> None:
    latch = {"latch": {"within": [0.1, 0.1]}}
    found = stages(chain(("one", latch, capture("a", "b")), ("two", latch, capture("b", "a"))))
    assert found[-1].remark == "closes a loop: b and a are already connected"
    assert found[-1].trees == found[-2].trees
    seated = capture("b", "a") | {"seat": 1}
    found = stages(chain(("one", latch, capture("a", "b")), ("two", latch, seated)))
    assert found[-1].remark.startswith("stops the run: b and a are already connected, so")


def test_a_loop_that_a_capture_closed_holds_the_systems_together_after_the_first_release() -> None:
    latch = {"latch": {"within": [0.1, 0.1]}}
    both = [("one", latch, capture("a", "b")), ("two", latch, capture("b", "a"))]
    found = stages(chain(*both, ("open", {"after": "two"}, {"release": "one"})))
    assert found[-1].trees == found[1].trees and not found[-1].remark
    apart = stages(chain(both[0], ("open", {"after": "one"}, {"release": "one"})))
    assert apart[-1].trees != apart[1].trees


def test_the_command_shows_systems_events_and_trees(tmp_path: Path) -> None:
    (tmp_path / "pair.yaml").write_text(PAIR)
    done = onorbit("info", "pair.yaml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    rows = [line.split() for line in done.stdout.splitlines()]
    assert "pair: 2 systems, 2 events" in done.stdout
    assert ["chaser", "servicer", "1088", "7", "joint_computed_torque"] in rows
    assert ["target", "target_satellite", "500", "0", "-"] in rows
    assert "latch: within 50 mm and 2 deg, slower than 150 mm/s and 5 deg/s, held for 0.1 s" in done.stdout
    assert "chaser/tool captures target/handle" in done.stdout
    assert "0.2 s after grasp" in done.stdout and "releases grasp with 2 N s" in done.stdout
    assert ["the", "start", "0", "chaser", "7", "1088"] in rows
    assert ["grasp", "-", "chaser", "+", "target", "7", "1588"] in rows
    assert ["let_go", "-", "chaser", "7", "1088"] in rows
    assert "order of the scenario" in done.stdout
    assert done.stdout.endswith("next: onorbit run pair.yaml --out DIR\n")


def test_the_command_prints_json() -> None:
    found = json.loads(onorbit("info", "capture_tumbling_target", "--json").stdout)
    assert [system["name"] for system in found["systems"]] == ["servicer", "target"]
    after = {stage["after"]: stage["trees"] for stage in found["trees"]}
    (tree,) = after["grasp"]
    assert (tree["systems"], tree["root"], tree["joints"]) == (["servicer", "target"], "servicer", 9)
    assert tree["seating_joints"] == 2
    assert np.isclose(tree["mass_kg"], sum(system["mass_kg"] for system in found["systems"]))
    assert len(after["let_go"]) == len(after[None]) == 2


def test_scenarios_of_one_robot_and_without_events(tmp_path: Path) -> None:
    done = onorbit("info", "humanoid_reach")
    assert done.stdout.startswith("humanoid_torso: ") and "onorbit run humanoid_reach" in done.stdout
    assert "no events: every system moves alone" in onorbit("info", "formation").stdout
    assert "no such scenario" in refusal("info", tmp_path / "none.yaml")
    assert "draws a single robot" in refusal("info", "formation", "--picture", tmp_path / "x.png")
    assert onorbit("info", "servicer").stdout.startswith("servicer: ")  # a robot, as before
    assert oo.robots.load("servicer").name == "servicer"
