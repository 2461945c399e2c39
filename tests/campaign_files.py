"""Campaigns for tests: short runs of one free-floating body and of a robot with an arm."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

import onorbit_rs as oo

BODY = {
    "name": "tumbler",
    "robot": {"rigid_body": {"mass": 10.0, "inertia": [1.0, 2.0, 2.5]}},
    "initial": {"angular_velocity": [0.1, 0.2, 0.3]},
    "simulation": {"duration": 0.02, "time_step": 1e-3},
}
"""A tumbling body, 20 steps."""


def reach(duration: float = 0.01) -> dict[str, Any]:
    """Returns the scenario humanoid_reach as a mapping, with another duration."""
    data = oo.scenario.load("humanoid_reach").resolved()
    data["simulation"] |= {"duration": duration}
    return data


def campaign_of(scenario: Any, vary: dict[str, Any], cases: int = 8, **more: Any) -> dict[str, Any]:
    """Returns a campaign as a mapping."""
    return {"campaign": {"scenario": scenario, "cases": cases, "seed": 1, "vary": vary} | more}


def spin(cases: int = 8, **more: Any) -> dict[str, Any]:
    """Returns a campaign that varies mass and spin of the tumbling body."""
    vary = {
        "robot.rigid_body.mass": {"set": {"uniform": [9.0, 11.0]}},
        "initial.angular_velocity": {"add": {"normal": [0.0, "1 deg/s"]}},
    }
    return campaign_of(BODY, vary, cases, **more)


def write(campaign: dict[str, Any], file: Path) -> Path:
    """Writes a campaign as YAML."""
    file.write_text(yaml.safe_dump(campaign, sort_keys=False))
    return file


MEASURED = ("wall_s", "real_time_factor")
"""Columns that are measured and differ between two runs of a case."""


def same(table: Any) -> Any:
    """Returns the columns of a table, without the measured ones."""
    return table.select([name for name in table.column_names if name.rpartition(".")[2] not in MEASURED])
