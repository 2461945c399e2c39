"""Scenarios of a world with a capture and a release, and with rows at different times."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.scenario import WorldScenario, load
from onorbit_rs.scenario.build_world import BuiltWorld, build_world
from onorbit_rs.scenario.yaml_lines import parse_yaml

PAIR = """\
orbit: {kind: kepler, semi_major_axis: 6778 km}
environment: [gravity_gradient]
systems:
  chaser:
    robot: servicer
    tool: tool
    initial: {joints: [0, 1.4260, 0, 1.3391, 0, -1.1943, 0], position: [0, 0.5, 0]}
    controller: {kind: joint_computed_torque, kp: 1, kd: 2}
    control_period: 20 ms
  target:
    robot: target_satellite
    initial:
      frame: chaser/tool
      position: [30 cm, 0, 75 cm]
      attitude: {roll_pitch_yaw: [0, -90 deg, 0]}
      angular_velocity: [0, 0, 1 deg/s]
events:
  - name: grasp
    when: {latch: {within: [5 cm, 2 deg], slower_than: [15 cm/s, 5 deg/s], held_for: 100 ms}}
    do: {capture: [chaser/tool, target/handle]}
  - name: let_go
    when: {after: grasp, delay: 0.2 s}
    do: {release: grasp, impulse: [0, 0, 2 N s, 0, 0, 0]}
simulation: {duration: 0.5 s, time_step: 10 ms}
"""


def data(text: str = PAIR, **changed: Any) -> dict[str, Any]:
    """Returns a scenario, by default that of the pair, with other top-level entries."""
    values: dict[str, Any] = parse_yaml(text, None)[0]
    return values | changed


def built(source: dict[str, Any] | str | Path) -> BuiltWorld:
    scenario = load(source)
    assert isinstance(scenario, WorldScenario)
    return build_world(scenario)


def check_line_of_error(
    read: Callable[[Path], object], change: tuple[str, str, str], line: int, words: str, folder: Path
) -> None:
    """Asserts that reading a scenario with one text replaced by another names the line of the error."""
    text, old, new = change
    file = folder / "scenario.yaml"
    assert old in text
    file.write_text(text.replace(old, new, 1))
    with pytest.raises(OnOrbitError, match=words) as caught:
        read(file)
    assert f"scenario.yaml:{line}" in str(caught.value)


def ran(world: BuiltWorld) -> oo.WorldTrace:
    trace: Any = world.simulation.run(world.scenario.simulation.duration)
    assert isinstance(trace, oo.WorldTrace)
    return trace


@cache
def pair() -> tuple[BuiltWorld, oo.WorldTrace]:
    world = built(data())
    return world, ran(world)


@cache
def trio() -> tuple[BuiltWorld, oo.WorldTrace]:
    """Returns the pair with a third satellite 40 m away, which has no rows at the times of the events."""
    values = data()
    values["systems"]["third"] = {"robot": "small_satellite", "initial": {"position": [0, 40, 0]}}
    world = built(values)
    return world, ran(world)
