"""Columns of the trace as time series, in f64, with a name and a unit on every line."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.rotations import attitude_in_orbit, has_local_frame, roll_pitch_yaw

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Trace

    Floats = NDArray[np.float64]

RED, GREEN, BLUE = (230, 92, 60), (60, 190, 130), (70, 150, 240)
_COLORS = [(70, 150, 240), (230, 120, 40), (60, 190, 130), (215, 130, 180), (235, 180, 40), (120, 205, 240),
           (170, 170, 170), (240, 230, 90)]  # fmt: skip


@dataclass(frozen=True)
class Series:
    """One plot: ``values`` (T, n), a name for each column, one unit for all."""

    path: str
    title: str
    unit: str
    names: tuple[str, ...]
    values: Floats


def series_of(trace: Trace, model: Model) -> Iterator[Series]:
    """Every plot this trace has the columns for."""
    columns = set(trace.columns())
    xyz = ("x", "y", "z")
    if model.joint_names:
        joints = tuple(model.joint_names)
        yield Series("plots/joint_torque", "Joint torques", "N m", joints, np.asarray(trace.tau))
        yield Series(
            "plots/joint_position", "Joint positions", "rad or m", joints, np.asarray(trace.q)[:, 7:]
        )
        yield Series("plots/joint_rate", "Joint rates", "rad/s or m/s", joints, np.asarray(trace.v)[:, 6:])
    if "position_error" in columns:
        error = np.asarray(trace.position_error)
        yield Series("plots/tool_position_error", "Tool position error", "m", xyz, error)
        error = np.asarray(trace.attitude_error)
        yield Series("plots/tool_attitude_error", "Tool attitude error", "rad", xyz, error)
    momentum = np.asarray(trace.momentum)
    yield Series("plots/linear_momentum", "Linear momentum", "N s", xyz, momentum[:, :3])
    yield Series(
        "plots/angular_momentum", "Angular momentum about the centre of mass", "N m s", xyz, momentum[:, 3:]
    )
    energy = np.column_stack([trace.kinetic_energy, trace.work])
    yield Series("plots/energy", "Energy and work", "J", ("kinetic energy", "work done"), energy)
    base = np.asarray(trace.q)
    yield Series("plots/base_position", "Base position in W", "m", xyz, base[:, :3])
    angles = np.degrees(np.unwrap(roll_pitch_yaw(base[:, 3:7]), axis=0))
    yield Series("plots/base_attitude", "Base attitude in W", "deg", ("roll", "pitch", "yaw"), angles)
    if "position_eci" in columns:
        position, velocity = np.asarray(trace.position_eci), np.asarray(trace.velocity_eci)
        if has_local_frame(trace):
            angles = np.degrees(attitude_in_orbit(base[:, 3:7], position, velocity))
            title = "Base attitude in the local orbital frame"
            yield Series("plots/base_attitude_lvlh", title, "deg", ("roll", "pitch", "yaw"), angles)
        yield Series("exact/position_eci", "Position of the base, inertial", "m", xyz, position)
        yield Series("exact/velocity_eci", "Velocity of the base, inertial", "m/s", xyz, velocity)


def send_series(
    recording: rr.RecordingStream, time: rr.TimeColumn, series: Series, rows: NDArray[np.int64]
) -> None:
    """One entity holding all lines of a plot."""
    count = len(series.names)
    colors = (RED, GREEN, BLUE) if series.names in (("x", "y", "z"), ("roll", "pitch", "yaw")) else _COLORS
    style = rr.SeriesLines(
        names=[f"{name} [{series.unit}]" for name in series.names],
        colors=[colors[index % len(colors)] for index in range(count)],
        widths=[1.5] * count,
    )
    recording.log(series.path, style, static=True, strict=True)
    values = series.values[rows]
    columns = rr.Scalars.columns(scalars=values.reshape(-1))
    recording.send_columns(series.path, [time], columns.partition([count] * len(values)), strict=True)
