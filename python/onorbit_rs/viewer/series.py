"""Groups of plots for the viewer, computed from the rows of a trace.

The lines of a plot share a unit label, which is ``rad or m`` for joint errors of both kinds of joints.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.coordinates import JOINTS_Q, JOINTS_V, QUATERNION
from onorbit_rs.common.display_units import OR, joint_units, with_prefix
from onorbit_rs.common.rotations import roll_pitch_yaw
from onorbit_rs.viewer.colors import LINES
from onorbit_rs.viewer.font import shown
from onorbit_rs.viewer.wrenches import centers_of_bodies, net_force, torque_about_center

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model
    from onorbit_rs.viewer.setting import Setting
    from onorbit_rs.viewer.trace_rows import TraceRows

    Floats = NDArray[np.float64]

_XYZ = [(240, 95, 75), (70, 200, 120), (85, 155, 250)]
_OTHERS, OTHERS = (90, 94, 104), "others, smaller"
AXES, ANGLES = ("x", "y", "z"), ("roll", "pitch", "yaw")
SUM, _SUM = "sum", (235, 235, 235)
"""Name and colour of the last line of a plot if that line is the sum of the others."""

_TOOL_ERRORS = (COLUMNS["position_error"], COLUMNS["attitude_error"])

LEAST_PEAK, LARGEST_PEAK = 0.1, 1e4
"""Range of peaks that are plotted in SI units (and degrees) without a prefix."""

ROUNDING = 1e-12
"""Magnitude, in SI units, below which a value is rounding error."""


@dataclass(frozen=True)
class Series:
    """One plot: ``values`` (T, n), a name for each column, and one unit for all columns."""

    group: str
    path: str
    title: str
    unit: str
    names: tuple[str, ...]
    values: Floats


def series_of(rows: TraceRows, setting: Setting, *, is_live: bool = False) -> Iterator[Series]:
    """Yield every plot whose columns the rows contain.

    Plots of a completed run have units that suit their peaks. Rounding errors are shown as zero, and effects
    that are zero are omitted.
    """
    parts = (
        _of_tools(rows, setting),
        _of_joints(rows, setting.model),
        _of_base(rows),
        _of_balances(rows),
        _of_loops(rows),
        _of_effects(rows, setting.model),
    )
    for series in chain.from_iterable(parts):
        fitted = series if is_live else fitted_unit(series)
        if is_live or series.group != "Forces" or fitted.values.any():
            root, _, name = fitted.path.partition("/")
            yield replace(fitted, path=f"{root}/{setting.system}/{name}") if setting.system else fitted


def fitted_unit(series: Series) -> Series:
    """Return the series in a unit that suits its peak.

    Rerun's axes show four decimals and no exponents. A peak below the rounding error gives zeros. Inertial
    positions and velocities, and plots whose label has two units, keep their unit.
    """
    peak = float(max(series.values.max(initial=0.0), -series.values.min(initial=0.0)))
    if peak < (np.degrees(ROUNDING) if series.unit == "deg" else ROUNDING):
        return replace(series, values=np.zeros_like(series.values))
    if LEAST_PEAK <= peak <= LARGEST_PEAK or series.path.startswith("exact/") or OR in series.unit:
        return series
    factor, unit = with_prefix(peak, series.unit)
    return replace(series, values=factor * series.values, unit=unit)


def _of_effects(rows: TraceRows, model: Model) -> Iterator[Series]:
    if not rows.wrenches:
        return
    centers = centers_of_bodies(rows, model)
    for effect, wrenches in rows.wrenches.items():
        name = effect.replace("_", " ").capitalize()
        force, torque = net_force(wrenches), torque_about_center(rows, centers, wrenches)
        parts = (("force", "net force", force), ("torque", "torque about the centre of mass", torque))
        for part, title, values in parts:
            _, unit = COLUMNS["wrenches"].parts[part]
            yield Series("Forces", f"plots/{effect}/{part}", f"{name}: {title}", unit, AXES, values)


def _of_loops(rows: TraceRows) -> Iterator[Series]:
    """Yield the plots of force, moment and opening of every closed loop."""
    parts = COLUMNS["loops"].parts
    for name, values in rows.loops.items():
        path = f"plots/loops/{name}"
        for part, title in (("force", "force on the second frame"), ("moment", "moment")):
            entries, unit = parts[part]
            yield Series("Loops", f"{path}/{part}", f"{name}: {title}", unit, AXES, values[:, entries])
        entries, units = parts["opening"]
        for number, (what, unit) in enumerate(
            zip(("opening", "opening_angle"), units.split(" and "), strict=True)
        ):
            title, own = what.replace("_", " "), values[:, entries][:, [number]]
            yield Series("Loops", f"{path}/{what}", f"{name}: {title}", unit, (title,), own)


def _of_tools(rows: TraceRows, setting: Setting) -> Iterator[Series]:
    if "position_error" in rows:
        for column in _TOOL_ERRORS:
            title = f"{shown(setting.tool or 'Tool')}: {column.name.replace('_', ' ')}"
            yield Series("Tool", f"plots/tool_{column.name}", title, column.unit, AXES, rows[column.name])
    for name, errors in rows.tracking.items():
        path = f"plots/tracking/{name}"
        if name in setting.grips:
            yield Series("Joints", path, f"{name}: force error", "N", ("force error",), errors)
            continue
        if errors.shape[1] == 2 * len(AXES):
            for column, part in zip(_TOOL_ERRORS, np.split(errors, 2, axis=1), strict=True):
                what = column.name.removesuffix("_error")
                yield Series("Tool", f"{path}/{what}", f"{name}: {what} error", column.unit, AXES, part)
        else:
            names = tuple(f"joint {index + 1}" for index in range(errors.shape[1]))
            units = joint_units(joint.kind for joint in setting.model.joints)
            what, unit = (
                ("joint rate errors", units.rate)
                if name in setting.rate_controls
                else ("joint errors", units.position)
            )
            yield Series("Joints", path, f"{name}: {what}", unit, names, errors)


def _of_joints(rows: TraceRows, model: Model) -> Iterator[Series]:
    """Yield the plots of the revolute and of the prismatic joints, which have different units."""
    slides = np.array([joint.kind == "prismatic" for joint in model.joints], bool)
    for who, kind, chosen in (("joint", "revolute", ~slides), ("slide", "prismatic", slides)):
        if not chosen.any():
            continue
        names = tuple(shown(name) for name in np.array(model.joint_names)[chosen])
        units, force = joint_units([kind]), "torque" if kind == "revolute" else "force"
        for what, unit, values in (
            (force, units.effort, rows["tau"]),
            ("position", units.position, rows["q"][:, JOINTS_Q]),
            ("rate", units.rate, rows["v"][:, JOINTS_V]),
        ):
            columns = values if chosen.all() else values[:, chosen]
            yield Series("Joints", f"plots/{who}_{what}", f"{who.capitalize()} {what}s", unit, names, columns)


def _of_base(rows: TraceRows) -> Iterator[Series]:
    q = rows["q"]
    if rows.quat_lb is not None:
        angles = np.degrees(np.unwrap(roll_pitch_yaw(rows.quat_lb), axis=0))
        title = "Base attitude relative to L (local orbital frame)"
        yield Series("Base", "plots/base_attitude_lvlh", title, "deg", ANGLES, angles)
    angles = np.degrees(np.unwrap(roll_pitch_yaw(q[:, QUATERNION]), axis=0))
    yield Series("Base", "plots/base_attitude", "Base attitude in W", "deg", ANGLES, angles)
    yield _of_part(rows, "Base", "plots/base_rate", "Base angular velocity, body axes", "v", "angular")
    yield _of_part(rows, "Base", "plots/base_position", "Base position in W", "q", "position")
    if "position_eci" in rows:
        for name, title in (("position_eci", "Base position"), ("velocity_eci", "Base velocity")):
            yield Series("Orbit", f"exact/{name}", f"{title}, inertial", COLUMNS[name].unit, AXES, rows[name])


def _of_balances(rows: TraceRows) -> Iterator[Series]:
    title = "Linear momentum in W"
    yield _of_part(rows, "Balance", "plots/linear_momentum", title, "momentum", "linear")
    title = "Angular momentum about the centre of mass"
    yield _of_part(rows, "Balance", "plots/angular_momentum", title, "momentum", "angular")
    energy = np.column_stack([rows["kinetic_energy"], rows["work"]])
    names, unit = ("kinetic energy", "work done"), COLUMNS["kinetic_energy"].unit
    yield Series("Balance", "plots/energy", "Energy and work", unit, names, energy)


def _of_part(rows: TraceRows, group: str, path: str, title: str, column: str, part: str) -> Series:
    """Return the plot of three components of a column."""
    entries, unit = COLUMNS[column].parts[part]
    return Series(group, path, title, unit, AXES, rows[column][:, entries])


def log_style(recording: rr.RecordingStream, series: Series) -> None:
    """Log the names and colours of the lines of a plot."""
    count = len(series.names)
    names, colors = list(series.names), list(_XYZ if series.names in (AXES, ANGLES) else LINES)
    if count > len(colors):  # more lines than colours: names distinguish the lines
        peaks = np.abs(series.values).max(axis=0)
        largest = np.sort(np.argsort(-peaks, kind="stable")[: len(colors)])
        taken = dict(zip(largest.tolist(), LINES, strict=True))
        colors = [taken.get(index, _OTHERS) for index in range(count)]
        names = [name if index in taken else OTHERS for index, name in enumerate(names)]
    elif names[-1] == SUM:
        colors[count - 1] = _SUM
    style = rr.SeriesLines(
        names=names,
        colors=colors[:count],
        widths=[1.5] * count,
        aggregation_policy=rr.components.AggregationPolicy.MinMax,  # the mean would hide oscillations
    )
    recording.log(series.path, style, static=True, strict=True)


def send_series(recording: rr.RecordingStream, rows: TraceRows, series: Series) -> None:
    """Send one entity with all lines of a plot."""
    columns = rr.Scalars.columns(scalars=series.values.reshape(-1))
    lengths = np.full(len(series.values), len(series.names))
    recording.send_columns(series.path, [rows.times], columns.partition(lengths), strict=True)
