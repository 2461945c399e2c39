"""The command `onorbit ros2`: its report, its errors, and what it needs."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from ros2_runs import DOMAIN, needs_ros2

from onorbit_rs import cli

WITHOUT = """
import importlib.util as util
real = util.find_spec
util.find_spec = lambda name, *rest: None if name in ("cyclonedds", "rosbags") else real(name, *rest)
from onorbit_rs import cli
cli.main(["ros2", "humanoid_reach"])
"""


def ran(*arguments: str) -> object:
    """Returns the exit code of the command."""
    with pytest.raises(SystemExit) as stop:
        cli.main(["ros2", *arguments])
    return stop.value.code


def test_the_package_does_not_import_the_extra() -> None:
    code = (
        "import sys, onorbit_rs, onorbit_rs.cli; print({'cyclonedds', 'rosbags', 'mcap'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"


def test_without_the_extra_one_line_says_how_to_install_it() -> None:
    done = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, text=True, check=False)
    assert done.returncode == 2 and done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert "require cyclonedds and rosbags" in line or "require rosbags and cyclonedds" in line
    assert line.endswith("to install them, use pip install 'onorbit-rs[ros2]'")


def test_the_command_runs_a_scenario_and_reports_it(capsys: pytest.CaptureFixture[str]) -> None:
    needs_ros2()
    assert ran("humanoid_reach", "--for", "0.1", "--domain", str(DOMAIN), "--json") in (0, None)
    printed = capsys.readouterr()
    report = json.loads(printed.out)
    assert report["certificate_passed"] is True and report["commands"] == 0
    assert report["jitter"]["ticks"] == 100
    assert "/joint_states                    sensor_msgs/msg/JointState" in printed.err


def test_the_domain_is_that_of_the_environment(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    needs_ros2()
    monkeypatch.setenv("ROS_DOMAIN_ID", "233")
    assert ran("humanoid_reach") == 2
    wanted = "must be an integer from 0 to 232"
    assert f"ROS_DOMAIN_ID in the environment is '233'; it {wanted}" in capsys.readouterr().err
    assert ran("humanoid_reach", "--domain", "233") == 2
    assert f"the DDS domain is 233; it {wanted}" in capsys.readouterr().err
    assert ran("humanoid_reach", "--domain", str(DOMAIN), "--for", "0.01") in (0, None)
    monkeypatch.setenv("ROS_DOMAIN_ID", f" {DOMAIN}")
    assert ran("humanoid_reach", "--for", "0.01") in (0, None)
    assert f"ROS 2 domain {DOMAIN}, publishing:" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--pace", "slow"], "pace is 'slow'; give one of real_time, fast, stepped"),
        (["--network", "wifi"], "network is 'wifi'; give 'loopback' or 'all'"),
        (["--for", "0"], "the duration is 0.0; it must be a positive number of seconds"),
        (["--for", "nan"], "the duration is nan; it must be a positive number of seconds"),
    ],
)
def test_wrong_options_are_named(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    needs_ros2()
    assert ran("humanoid_reach", "--quiet", "--domain", str(DOMAIN), *arguments) == 2
    assert message in capsys.readouterr().err


def test_the_log_of_a_run_without_commands_is_empty(tmp_path: Path) -> None:
    needs_ros2()
    log = tmp_path / "commands.jsonl"
    ran(
        "humanoid_reach",
        "--pace",
        "fast",
        "--for",
        "0.05",
        "--quiet",
        "--log",
        str(log),
        "--domain",
        str(DOMAIN),
    )
    assert log.read_text() == ""
