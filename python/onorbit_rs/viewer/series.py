"""Columns of the trace as time series, in f64, in groups, each plot with a unit and a name on every line."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs.rotations import roll_pitch_yaw
from onorbit_rs.units import OR, joint_units, with_prefix
from onorbit_rs.viewer.letters import shown
from onorbit_rs.viewer.wrenches import centers_of_bodies, torque_about_center

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.viewer.rows import Rows
    from onorbit_rs.viewer.setting import Setting

    Floats = NDArray[np.float64]

_XYZ = [(240, 95, 75), (70, 200, 120), (85, 155, 250)]
_COLORS = [(85, 155, 250), (240, 130, 50), (70, 200, 120), (220, 140, 190), (240, 190, 50), (130, 210, 245),
           (180, 180, 180), (245, 235, 100)]  # fmt: skip
_OTHERS, OTHERS = (90, 94, 104), "others, smaller"
_AXES, ANGLES = ("x", "y", "z"), ("roll", "pitch", "yaw")

LEAST_PEAK, LARGEST_PEAK = 0.1, 1e4
"""Between them values are plotted in SI units (and degrees)."""

ROUNDING = 1e-12
"""What stays below it, in SI units, is rounding."""


@dataclass(frozen=True)
class Series:
    """One plot: ``values`` (T, n), a name for each column, one unit for all."""

    group: str
    path: str
    title: str
    unit: str
    names: tuple[str, ...]
    values: Floats


def series_of(rows: Rows, setting: Setting, *, is_live: bool = False) -> Iterator[Series]:
    """Every plot that these rows have the columns for.

    Of a run that is over: in units that fit its peaks, rounding as zero, of effects what was not zero.
    """
    parts = (
        _of_tools(rows, setting),
        _of_joints(rows, setting.model),
        _of_base(rows),
        _of_balances(rows),
        _of_effects(rows, setting.model),
    )
    for series in chain.from_iterable(parts):
        fitted = series if is_live else _fitted(series)
        if is_live or series.group != "Forces" or fitted.values.any():
            yield fitted


def _fitted(series: Series) -> Series:
    """Rerun's axes tell four decimals and no exponents: small values want a smaller unit."""
    peak = float(max(series.values.max(initial=0.0), -series.values.min(initial=0.0)))
    if peak < (np.degrees(ROUNDING) if series.unit == "deg" else ROUNDING):
        return replace(series, values=np.zeros_like(series.values))
    if LEAST_PEAK <= peak <= LARGEST_PEAK or series.path.startswith("exact/") or OR in series.unit:
        return series
    factor, unit = with_prefix(peak, series.unit)
    return replace(series, values=factor * series.values, unit=unit)


def _of_effects(rows: Rows, model: Model) -> Iterator[Series]:
    if not rows.wrenches:
        return
    centers = centers_of_bodies(rows, model)
    for effect, wrenches in rows.wrenches.items():
        name = effect.replace("_", " ").capitalize()
        force, torque = wrenches[:, :, :3].sum(axis=1), torque_about_center(rows, centers, wrenches)
        parts = (
            ("force", "net force", "N", force),
            ("torque", "torque about the centre of mass", "N m", torque),
        )
        for part, title, unit, values in parts:
            yield Series("Forces", f"plots/{effect}/{part}", f"{name}: {title}", unit, _AXES, values)


def _of_tools(rows: Rows, setting: Setting) -> Iterator[Series]:
    if "position_error" in rows:
        for what, unit in (("position", "m"), ("attitude", "rad")):
            title = f"{shown(setting.tool or 'Tool')}: {what} error"
            yield Series("Tool", f"plots/tool_{what}_error", title, unit, _AXES, rows[f"{what}_error"])
    for name, errors in rows.tracking.items():
        path = f"plots/tracking/{name}"
        if errors.shape[1] == 6:
            yield Series("Tool", f"{path}/position", f"{name}: position error", "m", _AXES, errors[:, :3])
            yield Series("Tool", f"{path}/attitude", f"{name}: attitude error", "rad", _AXES, errors[:, 3:])
        else:
            names = tuple(f"joint {index + 1}" for index in range(errors.shape[1]))
            unit = joint_units(joint.kind for joint in setting.model.joints).position
            yield Series("Joints", path, f"{name}: joint errors", unit, names, errors)


def _of_joints(rows: Rows, model: Model) -> Iterator[Series]:
    """Those that turn, and in plots of their own those that slide."""
    slides = np.array([joint.kind == "prismatic" for joint in model.joints], bool)
    for who, kind, chosen in (("joint", "revolute", ~slides), ("slide", "prismatic", slides)):
        if not chosen.any():
            continue
        names = tuple(shown(name) for name in np.array(model.joint_names)[chosen])
        units, force = joint_units([kind]), "torque" if kind == "revolute" else "force"
        for what, unit, values in (
            (force, units.effort, rows["tau"]),
            ("position", units.position, rows["q"][:, 7:]),
            ("rate", units.rate, rows["v"][:, 6:]),
        ):
            columns = values if chosen.all() else values[:, chosen]
            yield Series("Joints", f"plots/{who}_{what}", f"{who.capitalize()} {what}s", unit, names, columns)


def _of_base(rows: Rows) -> Iterator[Series]:
    q, v = rows["q"], rows["v"]
    if rows.quat_lb is not None:
        angles = np.degrees(np.unwrap(roll_pitch_yaw(rows.quat_lb), axis=0))
        title = "Base attitude relative to L (local orbital frame)"
        yield Series("Base", "plots/base_attitude_lvlh", title, "deg", ANGLES, angles)
    angles = np.degrees(np.unwrap(roll_pitch_yaw(q[:, 3:7]), axis=0))
    yield Series("Base", "plots/base_attitude", "Base attitude in W", "deg", ANGLES, angles)
    yield Series("Base", "plots/base_rate", "Base angular velocity, body axes", "rad/s", _AXES, v[:, 3:6])
    yield Series("Base", "plots/base_position", "Base position in W", "m", _AXES, q[:, :3])
    if "position_eci" in rows:
        r, rate = rows["position_eci"], rows["velocity_eci"]
        yield Series("Orbit", "exact/position_eci", "Base position, inertial", "m", _AXES, r)
        yield Series("Orbit", "exact/velocity_eci", "Base velocity, inertial", "m/s", _AXES, rate)


def _of_balances(rows: Rows) -> Iterator[Series]:
    momentum = rows["momentum"]
    yield Series("Balance", "plots/linear_momentum", "Linear momentum in W", "N s", _AXES, momentum[:, :3])
    title = "Angular momentum about the centre of mass"
    yield Series("Balance", "plots/angular_momentum", title, "N m s", _AXES, momentum[:, 3:])
    energy = np.column_stack([rows["kinetic_energy"], rows["work"]])
    names = ("kinetic energy", "work done")
    yield Series("Balance", "plots/energy", "Energy and work", "J", names, energy)


def log_style(recording: rr.RecordingStream, series: Series) -> None:
    """Names and colours of the lines of a plot."""
    count = len(series.names)
    names, colors = list(series.names), list(_XYZ if series.names in (_AXES, ANGLES) else _COLORS)
    if count > len(colors):  # none has another's colour
        peaks = np.abs(series.values).max(axis=0)
        largest = np.sort(np.argsort(-peaks, kind="stable")[: len(colors)])
        taken = dict(zip(largest.tolist(), _COLORS, strict=True))
        colors = [taken.get(index, _OTHERS) for index in range(count)]
        names = [name if index in taken else OTHERS for index, name in enumerate(names)]
    style = rr.SeriesLines(
        names=names,
        colors=colors[:count],
        widths=[1.5] * count,
        aggregation_policy=rr.components.AggregationPolicy.MinMax,  # the mean of chatter is none
    )
    recording.log(series.path, style, static=True, strict=True)


def send_series(recording: rr.RecordingStream, rows: Rows, series: Series) -> None:
    """One entity with all lines of a plot."""
    columns = rr.Scalars.columns(scalars=series.values.reshape(-1))
    lengths = np.full(len(series.values), len(series.names))
    recording.send_columns(series.path, [rows.times], columns.partition(lengths), strict=True)
