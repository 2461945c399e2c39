"""The controller ``external`` in scenarios."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build

SETTINGS = {"duration": "0.3 s", "time_step": "2 ms", "control_period": "10 ms"}


def scenario(**changes: Any) -> dict[str, Any]:
    return {"robot": "servicer", "simulation": SETTINGS} | changes


def test_a_single_controller_takes_commands_and_reports_its_errors() -> None:
    given = scenario(
        controller={"kind": "external", "kp": 100, "kd": 20, "timeout": "0.1 s", "on_timeout": "damp"}
    )
    command = {"time": 0.1, "control": "control", "position": [0.01] * 7}
    with pytest.warns(
        UserWarning, match="the controller external receives no commands.*hold their initial positions"
    ):
        still = oo.run(given, quiet=True)
    assert np.abs(np.asarray(still.trace.q)[:, 7:]).max() < 1e-9
    run = oo.run(given, commands=[command], quiet=True)
    assert run.summary["tracking_joint_error_max_rad"] == pytest.approx(0.01)
    assert run.summary["certificate_passed"]
    assert not any("external" in text for text in run.summary.get("warnings", []))
    assert np.abs(np.asarray(run.trace.q)[-1, 7:] - np.asarray(run.trace.q)[50, 7:]).min() > 1e-4


def test_the_keys_are_those_of_the_law(tmp_path: Path) -> None:
    controls = [
        {
            "name": "arm",
            "kind": "external",
            "joints": "joint_[1-4]",
            "kp": [1, 2, 3, 4],
            "kd": 5,
            "timeout": "200 ms",
        },
        {"name": "wrist", "kind": "external", "joints": ["joint_5"], "start": "0.1 s", "end": "0.2 s"},
    ]
    loaded = load(scenario(controllers=controls))
    stepper = build(loaded).simulation.start()
    assert stepper.external == {"arm": [f"joint_{i}" for i in range(1, 5)], "wrist": ["joint_5"]}
    assert stepper.interfaces == {"arm": "position", "wrist": "effort"}
    resolved = loaded.resolved(tmp_path)
    assert resolved["controllers"][0]["timeout"] == 0.2 and load(resolved).resolved(tmp_path) == resolved


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"kp": -1}, "kp is -1; it must not be negative"),
        ({"timeout": "0 s"}, "it must be above zero"),
        ({"timeout": "1 s"}, r"on_timeout 'hold' requires kp > 0"),
        ({"timeout": "1 s", "on_timeout": "damp"}, r"on_timeout 'damp' requires kd > 0"),
        ({"on_timeout": "stop"}, "on_timeout"),
        ({"reference": {"kind": "joint_hold"}}, "gets its motion from commands, so it has no 'reference'"),
        ({"goal": {"tolerance": "1 deg"}}, "no 'goal'"),
        ({"starts_at_present": True}, "no 'starts_at_present'"),
        ({"time_out": "1 s"}, "did you mean 'timeout'"),
    ],
)  # fmt: skip
def test_wrong_keys_are_errors(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(oo.OnOrbitError, match=message):
        build(load(scenario(controllers=[{"name": "arm", "kind": "external"} | changes])))


def test_gains_that_are_too_high_for_the_control_period_are_warned_of() -> None:
    with pytest.warns(UserWarning, match=r"controller\.kd corrects errors at a rate of 300 1/s"):
        build(load(scenario(controller={"kind": "external", "kp": 100, "kd": 300})))
