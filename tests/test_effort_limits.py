"""Effort limits: which ones apply, and the report of joints that reached them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.cli.summary import print_summary
from onorbit_rs.output.joints import efforts_at_limit, largest_fractions
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build


@pytest.fixture
def robot(tmp_path: Path) -> str:
    """Writes the URDF of two hinges with effort limits of 0.5 and 50 N m, and returns its path."""
    body = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
    links = "".join(f"<link name='{name}'>{body}</link>" for name in ("base", "of_weak", "of_strong"))
    hinges = "".join(
        f"<joint name='{name}' type='revolute'><parent link='base'/><child link='of_{name}'/>"
        f"<axis xyz='0 0 1'/><limit lower='-9' upper='9' velocity='9' effort='{effort}'/></joint>"
        for name, effort in (("weak", 0.5), ("strong", 50))
    )
    file = tmp_path / "hinges.urdf"
    file.write_text(f"<robot name='hinges'>{links}{hinges}</robot>")
    return str(file)


def led(robot: str, **law: Any) -> dict[str, Any]:
    """Returns a scenario in which both hinges are 1 rad off their reference, so that they require 5 N m."""
    reference = {"kind": "joint_waypoints", "points": [[1.0, 1.0]], "times": [0.001]}
    return {
        "robot": {"urdf": robot}, "controller": {"kind": "joint_pid", "p": 5.0, "d": 5.0} | law,
        "reference": reference, "simulation": {"duration": 0.1, "time_step": 0.002},
    }  # fmt: skip


@pytest.mark.parametrize(
    ("law", "largest", "limited"),
    [
        ({}, (0.5, 5.0), "weak"),  # the limits of the file
        ({"effort_limit": 2.0}, (2.0, 2.0), "weak, strong"),
        ({"effort_limit": [1e9, 1.5]}, (5.0, 1.5), "strong"),
        ({"effort_limit": 1e9}, (5.0, 5.0), ""),
    ],
)
def test_a_pid_has_the_limits_of_the_file_by_default(
    robot: str, law: dict[str, Any], largest: tuple[float, float], limited: str
) -> None:
    run = oo.run(led(robot, **law), quiet=True)
    np.testing.assert_allclose(np.abs(run.trace.tau).max(axis=0), largest, rtol=0.02)
    assert run.summary["joint_efforts_at_limit"] == limited


def test_the_joints_of_one_of_several_controllers_are_named(robot: str) -> None:
    data = led(robot)
    law = data.pop("controller") | {"name": "one", "joints": ["w*"], "reference": data.pop("reference")}
    law["reference"]["points"] = [{"weak": 1.0}]
    run = oo.run(data | {"controllers": [law]}, quiet=True)
    assert run.summary["joint_efforts_at_limit"] == "weak"


def test_computed_torque_is_not_limited_and_reports_no_limits(robot: str) -> None:
    law = {"kind": "joint_computed_torque", "kp": 25.0, "kd": 10.0}
    run = oo.run(led(robot) | {"controller": law}, quiet=True)
    assert np.abs(run.trace.tau)[:, 0].max() > 0.5
    built = build(load(led(robot) | {"controller": law}))
    assert efforts_at_limit(run.trace, built) == {}
    assert "joint_efforts_at_limit" not in run.summary


def test_joints_at_their_limits_are_printed(robot: str, capsys: pytest.CaptureFixture[str]) -> None:
    print_summary(oo.run(led(robot), quiet=True).summary, None)
    assert "joint efforts were at their limits: weak\n" in capsys.readouterr().out
    print_summary(oo.run(led(robot, effort_limit=1e9), quiet=True).summary, None)
    assert "at their limits" not in capsys.readouterr().out


@pytest.mark.parametrize("kind", ["joint_computed_torque", "joint_pid", "controllers", "none"])
def test_exceeded_rates_and_efforts_are_named_under_every_control_law(robot: str, kind: str) -> None:
    """The weak hinge needs 3 N m (limit 0.5); the strong one starts at 10 rad/s (limit 9)."""
    data = led(robot, effort_limit=1e9)
    data["initial"] = {"joint_rates": {"strong": 10.0}}
    law = {"kind": "joint_computed_torque", "kp": 25.0, "kd": 10.0}
    if kind == "joint_computed_torque":
        data["controller"] = law
    elif kind == "controllers":
        law |= {"name": "one", "joints": ["weak"], "reference": data.pop("reference")}
        law["reference"]["points"] = [{"weak": 1.0}]
        del data["controller"]
        data["controllers"] = [law]
    elif kind == "none":
        del data["controller"], data["reference"]
    summary = oo.run(data, quiet=True).summary
    assert summary["joint_rates_exceeded"] == "strong"
    assert ("weak" in summary["joint_efforts_exceeded"]) == (kind != "none")


def test_a_joint_at_its_limit_does_not_exceed_it_and_zero_is_no_limit() -> None:
    values = np.array([[0.5, -3.0, 1.0, 7.0], [-0.5, 2.0, 1.0, 1.0]])
    np.testing.assert_array_equal(largest_fractions(values, [0.5, 2.0, 0.0, None]), [1.0, 1.5, 0.0, 0.0])


def test_exceeded_limits_are_printed(robot: str, capsys: pytest.CaptureFixture[str]) -> None:
    run = oo.run(led(robot, effort_limit=1e9), quiet=True)
    print_summary(run.summary, None)
    assert "effort limits of joints were exceeded: weak" in capsys.readouterr().out
