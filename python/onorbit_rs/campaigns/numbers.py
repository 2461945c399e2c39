"""Converts the summary of a case to one flat mapping of names to numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from onorbit_rs.common.event_kinds import OF_CONTACT

_ELSEWHERE = ("scenario", "status", "warnings")
_CONSTANT = (
    "engine", "integrator", "onorbit_rs_version", "instruction_set", "python_version", "numpy_version",
    "mujoco_version", "inertial_axes", "velocity_eci_source", "gravity_mode", "robot_fingerprint",
)  # fmt: skip
"""Entries of the summary that are the same for every case, or that identify a robot."""


EVENT_NUMBERS = (
    "count", "time_s", "impulse_ns", "angular_impulse_nms", "energy_lost_j", "linear_momentum_error_rel",
    "angular_momentum_error_rel", "peak_force_n",
)  # fmt: skip
"""Keys of the numbers in the entry of an event that happened."""


def numbers_of(summary: Mapping[str, Any]) -> dict[str, Any]:
    """Return the numbers, truth values and texts of results in a summary, by name.

    Entries of a system begin with ``systems.NAME.``, those of checks, contacts and events with
    ``certificate.NAME.``, ``contacts.NAME.`` and ``events.NAME.``. Of events with the same name, the first
    is used; ``events.NAME.count`` is their number. Touch-downs and lift-offs are left out.
    """
    found: dict[str, Any] = {}
    for key, value in summary.items():
        if key == "systems":
            for system, own in value.items():
                found |= {f"systems.{system}.{name}": number for name, number in numbers_of(own).items()}
        elif key == "events":
            found |= _events(value)
        elif isinstance(value, list):
            for entry in value:
                found |= _entries(f"{key}.{entry['name']}", entry)
        elif key not in (*_ELSEWHERE, *_CONSTANT):
            found[key] = value
    return found


def _events(events: list[dict[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for event in events:
        if event["kind"] in OF_CONTACT:
            continue
        name = f"events.{event['name']}"
        if f"{name}.count" in found:
            found[f"{name}.count"] += 1
        else:
            found |= {f"{name}.count": 1} | _entries(name, event)
    return found


def _entries(name: str, entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return the numbers and truth values of one entry of a list."""
    return {
        f"{name}.{key}": value
        for key, value in entry.items()
        if key != "name" and (value is None or isinstance(value, (bool, int, float)))
    }
