"""Environment and surfaces of scenarios with several systems, and surfaces of a single robot."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from world_runs import built, data

import onorbit_rs as oo
from onorbit_rs.exceptions import ScenarioError
from onorbit_rs.scenario import load

TEXT = """\
orbit: {semi_major_axis: 6678 km, inclination: 51 deg}
epoch: 2024-03-01T12:00:00 UTC
environment:
  - drag
  - {kind: radiation_pressure, bodies: {target: faces, chaser/bus: {kind: cannonball, area: 4}}}
  - {kind: body_wrench, body: target/bus, force: [0, 2, 0], start: 0.1, end: 0.25}
systems:
  chaser:
    robot: servicer
    surfaces: {bus: {kind: cannonball, area: 3}}
  target:
    robot: target_satellite
    initial: {frame: lvlh, position: [0, 5, 0]}
    surfaces: {kind: faces, drag_coefficient: 2}
simulation: {duration: 0.4 s, time_step: 50 ms, record_wrenches: true}
"""


def test_effects_and_surfaces_equal_those_of_the_same_world_in_python() -> None:
    declared = built(data(TEXT))
    chaser, target = declared.systems["chaser"], declared.systems["target"]
    systems = [
        oo.System("chaser", chaser.model, chaser.q, chaser.v, surfaces={"bus": oo.Cannonball(3.0)}),
        oo.System("target", target.model, target.q, target.v, surfaces=oo.Faces(drag_coefficient=2.0)),
    ]
    light = {"target": oo.Faces(), "chaser/bus": oo.Cannonball(4.0)}
    effects = [
        oo.Drag(oo.ExponentialAtmosphere()), oo.RadiationPressure(surfaces=light),
        oo.BodyWrench("target/bus", force=[0, 2, 0], start=0.1, end=0.25),
    ]  # fmt: skip
    world = oo.World(systems, orbit=declared.orbit, earth=declared.earth, environment=effects)
    expected = oo.Simulation(world, time_step=0.05, record_wrenches=True).run(0.4)
    found = oo.run(data(TEXT), quiet=True).trace
    assert isinstance(found, oo.WorldTrace)
    for name in ("chaser", "target"):
        np.testing.assert_array_equal(found[name].q, expected[name].q)
        for effect, rows in expected[name].wrenches.items():
            np.testing.assert_array_equal(found[name].wrenches[effect], rows)
    assert set(found["chaser"].wrenches) == {"drag", "radiation_pressure", "gravity"}
    active = np.abs(found["target"].wrenches["body_wrench"]).max(axis=(1, 2)) > 0
    assert active.sum() == 3  # the rows at 0.1, 0.15 and 0.2 s


def test_the_written_scenario_gives_the_same_run(tmp_path: Path) -> None:
    file = tmp_path / "two.yaml"
    file.write_text(TEXT)
    run = oo.run(file, tmp_path / "out", quiet=True)
    again = oo.run(tmp_path / "out" / "scenario.yaml", quiet=True)
    assert isinstance(run.trace, oo.WorldTrace) and isinstance(again.trace, oo.WorldTrace)
    np.testing.assert_array_equal(again.trace["target"].q, run.trace["target"].q)


def test_an_error_of_a_system_alone_names_the_effect_in_the_world() -> None:
    # the wrench of the chaser is its second effect, but the third one of the world
    values = data(TEXT)
    values["environment"] = [
        {"kind": "body_wrench", "body": "target/bus", "force": [1, 0, 0]},
        "gravity_gradient",
        {"kind": "body_wrench", "body": "chaser/arm", "force": [1, 0, 0]},
    ]
    with pytest.raises(oo.exceptions.FrameError, match=r"environment\[2\]: no body is named 'arm'"):
        built(values)


def test_surfaces_of_a_single_robot() -> None:
    one = {
        "robot": "target_satellite",
        "epoch": "2024-03-01T12:00:00 UTC",
        "orbit": {"semi_major_axis": 6678e3},
        "simulation": {"duration": 1, "time_step": 0.1},
    }
    ball = {"bus": {"kind": "cannonball", "area": 5}}
    by_robot = oo.run(one | {"surfaces": ball, "environment": ["drag", "radiation_pressure"]}, quiet=True)
    effects = [{"kind": kind, "bodies": ball} for kind in ("drag", "radiation_pressure")]
    by_effect = oo.run(one | {"environment": effects}, quiet=True)
    np.testing.assert_array_equal(by_robot.trace.q, by_effect.trace.q)
    default = oo.run(one | {"environment": ["drag", "radiation_pressure"]}, quiet=True)
    assert not np.array_equal(default.trace.q, by_robot.trace.q)
    faces = oo.run(one | {"surfaces": "faces", "environment": ["drag", "radiation_pressure"]}, quiet=True)
    np.testing.assert_array_equal(faces.trace.q, default.trace.q)


def test_one_surface_for_all_systems_must_be_their_faces() -> None:
    values = data(TEXT)
    values["environment"][0] = {"kind": "drag", "surfaces": {"kind": "cannonball", "area": 2}}
    with pytest.raises(
        ScenarioError, match=r"environment\[0\].surfaces: a surface of kind cannonball belongs to one"
    ):
        load(values)
