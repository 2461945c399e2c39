"""Aligns the rows of two runs in time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.common.coordinates import QUATERNION
from onorbit_rs.common.numbers import shortest
from onorbit_rs.common.rotations import angle_between, quaternion_from_matrix
from onorbit_rs.exceptions import CompareError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.tools.comparison.recorded import Recorded

    Floats = NDArray[np.float64]
    Rows = dict[str, Floats]

SAME_INSTANT = 1e-9
"""Largest difference, as a fraction of the mean step, of two instants that are considered equal."""


def aligned_rows(a: Recorded, b: Recorded) -> tuple[Rows, Rows, Floats, list[str]]:
    """Return the rows of both runs at common instants, these instants, and remarks.

    Rows at equal instants are used unchanged. The second run is interpolated at the instants of the first run
    if the rows at equal instants are fewer than half of its rows and fewer than half of the first run's rows
    in the common time span.

    Raises
    ------
    CompareError
        If the runs do not overlap in time.
    """
    rows_a, rows_b = (_one_row_per_instant(run.columns) for run in (a, b))
    time_a, time_b = rows_a["time"], rows_b["time"]
    start, end = max(time_a[0], time_b[0]), min(time_a[-1], time_b[-1])
    if not end >= start:
        raise CompareError(
            f"{a.name} covers {shortest(time_a[0])} to {shortest(time_a[-1])} s, and {b.name} covers "
            f"{shortest(time_b[0])} to {shortest(time_b[-1])} s; runs must overlap in time to be compared",
            name="time", got=(float(time_b[0]), float(time_b[-1])),
            expected=(float(time_a[0]), float(time_a[-1])),
        )  # fmt: skip
    remarks = []
    if abs(time_a[-1] - time_b[-1]) > SAME_INSTANT * (1.0 + end):
        ends = f"{a.name} ends at {time_a[-1]:.12g} s, {b.name} at {time_b[-1]:.12g} s"
        remarks.append(f"{ends}: compared until {end:.12g} s")
    at_a, at_b = _equal_instants(time_a, time_b)
    within = (time_a >= start) & (time_a <= end)
    if 2 * len(at_a) >= min(int(within.sum()), len(time_b)):
        return _take(rows_a, at_a), _take(rows_b, at_b), time_a[at_a], remarks
    remarks.append(f"rows of {b.name} are interpolated at the times of {a.name}, because most times differ")
    rows_a = _take(rows_a, np.flatnonzero(within))
    return rows_a, _interpolated(rows_b, rows_a["time"]), rows_a["time"], remarks


def _one_row_per_instant(columns: Rows) -> Rows:
    """Return the last row of each instant, with quaternions of base and tool and the position of the tool."""
    time = columns["time"]
    last = np.flatnonzero(np.append(np.diff(time) > 0.0, True))
    rows = {name: values[last] for name, values in columns.items() if len(values) == len(time)}
    if "tool_pose" in rows:
        pose = rows.pop("tool_pose").reshape(-1, 4, 4)
        rows["tool_position"], rows["tool_quat"] = pose[:, :3, 3], quaternion_from_matrix(pose[:, :3, :3])
    rows["base_quat"] = rows["q"][:, QUATERNION]
    return rows


def _take(rows: Rows, at: NDArray[np.intp]) -> Rows:
    return {name: values[at] for name, values in rows.items()}


def _equal_instants(time_a: Floats, time_b: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the indices of equal instants in both arrays."""
    spacing = max(time_a[-1] - time_a[0], time_b[-1] - time_b[0]) / max(len(time_a), len(time_b))
    near = (
        np.clip(np.searchsorted(time_b, time_a), 1, len(time_b) - 1)
        if len(time_b) > 1
        else np.zeros(len(time_a), int)
    )
    if len(time_b) > 1:
        near = np.where(time_a - time_b[near - 1] < time_b[near] - time_a, near - 1, near)
    is_equal = np.abs(time_b[near] - time_a) <= np.maximum(SAME_INSTANT * spacing, 4e-16 * np.abs(time_a))
    return np.flatnonzero(is_equal), near[is_equal]


def _interpolated(rows: Rows, at: Floats) -> Rows:
    """Return the rows at the times ``at``, s, of which most columns are interpolated linearly.

    Quaternions are interpolated by slerp, and inertial positions by cubics if the velocities are known;
    torques are held. With cubics, the column ``hermite_error`` contains an estimate of their error, m.
    """
    time = rows["time"]
    if len(time) == 1:
        return {name: np.repeat(values, len(at), axis=0) for name, values in rows.items()}
    before = np.clip(np.searchsorted(time, at, side="right") - 1, 0, len(time) - 2)
    s = ((at - time[before]) / np.diff(time)[before])[:, None]
    interpolated = {}
    for name, values in rows.items():
        columns = values.reshape(len(values), -1)
        first, second = columns[before], columns[before + 1]
        if name == "tau":
            mixed = np.where(s < 1.0, first, second)
        elif name.endswith("quat"):
            mixed = _slerp(first, second, s)
        elif name == "position_eci" and "velocity_eci" in rows:
            rates = rows["velocity_eci"][before], rows["velocity_eci"][before + 1]
            step = np.diff(time)[before][:, None]
            mixed = _hermite(first, second, *rates, s, step)
            interpolated["hermite_error"] = _hermite_error(first, rates[0], s, step)
        else:
            mixed = first + s * (second - first)
        interpolated[name] = mixed.reshape(len(at), *values.shape[1:])
    return interpolated


def _hermite(
    first: Floats, second: Floats, rate_a: Floats, rate_b: Floats, s: Floats, step: Floats
) -> Floats:
    """Return the cubic Hermite interpolation at the fractions ``s`` of steps with the lengths ``step``.

    Linear interpolation would not suffice: on an orbit of radius `r` and speed `v`, its error over a step `h`
    is `v² h² / (8 r)`, 16 km for 120 s in a low orbit.
    """
    weight = s * s * (3.0 - 2.0 * s)
    rates = s * (1.0 - s) * ((1.0 - s) * rate_a - s * rate_b)
    return first + weight * (second - first) + step * rates


def _hermite_error(position: Floats, velocity: Floats, s: Floats, step: Floats) -> Floats:
    """Return twice the cubic's error, m: `s² (1 − s)² h⁴ |r⁗| / 24` at a fraction `s` of a step `h`.

    The fourth derivative is that of a circular orbit, `|r⁗| = v⁴ / r³`.
    """
    radius, speed = (np.linalg.norm(rows, axis=1) for rows in (position, velocity))
    fourth = speed**4 / np.maximum(radius, 1.0) ** 3
    error: Floats = 2.0 * ((s * (1.0 - s) * step**2) ** 2)[:, 0] * fourth / 24.0
    return error


def _slerp(first: Floats, second: Floats, s: Floats) -> Floats:
    """Return `(sin (1 − s)θ a + sin sθ b) / sin θ`, slerp at `s` of quaternions `a`, `b` with angle `θ`."""
    second = np.where(np.sum(first * second, axis=1, keepdims=True) < 0.0, -second, second)
    angle = angle_between(first, second)[:, None] / 2.0
    with np.errstate(invalid="ignore", divide="ignore"):
        a, b = np.sin((1.0 - s) * angle) / np.sin(angle), np.sin(s * angle) / np.sin(angle)
    is_small = angle < 1e-8
    return np.where(is_small, 1.0 - s, a) * first + np.where(is_small, s, b) * second
