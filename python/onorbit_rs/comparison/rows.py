"""Rows of two runs at the same instants."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.exceptions import CompareError
from onorbit_rs.rotations import angle_between, quaternion_from_matrix

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.comparison.recorded import Recorded

    Floats = NDArray[np.float64]
    Rows = dict[str, Floats]

SAME_INSTANT = 1e-9
"""Share of the mean step within which two instants are one."""


def common_rows(a: Recorded, b: Recorded) -> tuple[Rows, Rows, Floats, list[str]]:
    """Rows of both at their common instants, these, and remarks.

    Instants that both have are taken as they are. Where these are fewer than half of the rows of either, the
    second run is interpolated at the rows of the first.

    Raises
    ------
    CompareError
        There is no time in common.
    """
    rows_a, rows_b = (_ready(run.columns) for run in (a, b))
    time_a, time_b = rows_a["time"], rows_b["time"]
    start, end = max(time_a[0], time_b[0]), min(time_a[-1], time_b[-1])
    if not end >= start:
        raise CompareError(
            f"{a.name} goes from {time_a[0]:g} to {time_a[-1]:g} s, {b.name} from {time_b[0]:g} to "
            f"{time_b[-1]:g} s: they have no time in common",
            name="time", got=(float(time_b[0]), float(time_b[-1])),
            expected=(float(time_a[0]), float(time_a[-1])),
        )  # fmt: skip
    remarks = []
    if abs(time_a[-1] - time_b[-1]) > SAME_INSTANT * (1.0 + end):
        ends = f"{a.name} ends at {time_a[-1]:g} s, {b.name} at {time_b[-1]:g} s"
        remarks.append(f"{ends}: compared until {end:g} s")
    at_a, at_b = _shared(time_a, time_b)
    within = (time_a >= start) & (time_a <= end)
    if 2 * len(at_a) >= min(int(within.sum()), len(time_b)):
        return _take(rows_a, at_a), _take(rows_b, at_b), time_a[at_a], remarks
    remarks.append(f"rows of {b.name} are interpolated at those of {a.name}: most instants are not the same")
    rows_a = _take(rows_a, np.flatnonzero(within))
    return rows_a, _between(rows_b, rows_a["time"]), rows_a["time"], remarks


def _ready(columns: Rows) -> Rows:
    """One row per instant, the last of those at an impact; the tool's pose as position and quaternion."""
    time = columns["time"]
    last = np.flatnonzero(np.append(np.diff(time) > 0.0, True))
    rows = {name: values[last] for name, values in columns.items() if len(values) == len(time)}
    if "tool_pose" in rows:
        pose = rows.pop("tool_pose").reshape(-1, 4, 4)
        rows["tool_position"], rows["tool_quat"] = pose[:, :3, 3], quaternion_from_matrix(pose[:, :3, :3])
    rows["base_quat"] = rows["q"][:, 3:7]
    return rows


def _take(rows: Rows, at: NDArray[np.intp]) -> Rows:
    return {name: values[at] for name, values in rows.items()}


def _shared(time_a: Floats, time_b: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Places of the instants that both have."""
    spacing = max(time_a[-1] - time_a[0], time_b[-1] - time_b[0]) / max(len(time_a), len(time_b))
    near = (
        np.clip(np.searchsorted(time_b, time_a), 1, len(time_b) - 1)
        if len(time_b) > 1
        else np.zeros(len(time_a), int)
    )
    if len(time_b) > 1:
        near = np.where(time_a - time_b[near - 1] < time_b[near] - time_a, near - 1, near)
    is_shared = np.abs(time_b[near] - time_a) <= np.maximum(SAME_INSTANT * spacing, 4e-16 * np.abs(time_a))
    return np.flatnonzero(is_shared), near[is_shared]


def _between(rows: Rows, at: Floats) -> Rows:
    """Straight between rows, quaternions at a steady rate, orbits by their velocities; torques are held."""
    time = rows["time"]
    if len(time) == 1:
        return {name: np.repeat(values, len(at), axis=0) for name, values in rows.items()}
    before = np.clip(np.searchsorted(time, at, side="right") - 1, 0, len(time) - 2)
    share = ((at - time[before]) / np.diff(time)[before])[:, None]
    made = {}
    for name, values in rows.items():
        columns = values.reshape(len(values), -1)
        first, second = columns[before], columns[before + 1]
        if name == "tau":
            mixed = np.where(share < 1.0, first, second)
        elif name.endswith("quat"):
            mixed = _turned(first, second, share)
        elif name == "position_eci" and "velocity_eci" in rows:
            rates = rows["velocity_eci"][before], rows["velocity_eci"][before + 1]
            step = np.diff(time)[before][:, None]
            mixed = _bent(first, second, *rates, share, step)
            made["bend_error"] = _bend_error(first, rates[0], share, step)
        else:
            mixed = first + share * (second - first)
        made[name] = mixed.reshape(len(at), *values.shape[1:])
    return made


def _bent(
    first: Floats, second: Floats, rate_a: Floats, rate_b: Floats, share: Floats, step: Floats
) -> Floats:
    """Cubic with these ends and rates: a chord is `v² h² / 8 r` off an orbit, 8 km in two minutes."""
    late = share * share * (3.0 - 2.0 * share)
    rates = share * (1.0 - share) * ((1.0 - share) * rate_a - share * rate_b)
    return first + late * (second - first) + step * rates


def _bend_error(place: Floats, rate: Floats, share: Floats, step: Floats) -> Floats:
    """Of the cubic, m: `s² (1 − s)² h⁴ |r⁗| / 24`, where a circle has `|r⁗| = v⁴ / r³`; twice that."""
    radius, speed = (np.linalg.norm(rows, axis=1) for rows in (place, rate))
    fourth = speed**4 / np.maximum(radius, 1.0) ** 3
    error: Floats = 2.0 * ((share * (1.0 - share) * step**2) ** 2)[:, 0] * fourth / 24.0
    return error


def _turned(first: Floats, second: Floats, share: Floats) -> Floats:
    """A share of the way from one attitude to another: `(sin (1 − s)θ a + sin sθ b) / sin θ`."""
    second = np.where(np.sum(first * second, axis=1, keepdims=True) < 0.0, -second, second)
    angle = angle_between(first, second)[:, None] / 2.0
    with np.errstate(invalid="ignore", divide="ignore"):
        a, b = np.sin((1.0 - share) * angle) / np.sin(angle), np.sin(share * angle) / np.sin(angle)
    is_small = angle < 1e-8
    return np.where(is_small, 1.0 - share, a) * first + np.where(is_small, share, b) * second
