"""Figure of the force with which a gripper holds an object."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from onorbit_rs.figures.style import COLUMN, INK, LINE, XYZ_COLORS, clock, legend_above, new_figure, tidy

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Grip:
    """Control that closes a gripper.

    Attributes
    ----------
    force : float
        Desired force, N.
    ramp : float
        Time in which the commanded force would increase from zero to ``force``, s.
    fingers : tuple of tuple of str
        Names of the contacts of each finger; empty if they are not known.
    pressures : dict or None
        Normal forces of these contacts, (T,), N, by the name of the contact; None if they are not known.
    """

    force: float
    ramp: float = 0.0
    fingers: tuple[tuple[str, ...], ...] = ()
    pressures: Mapping[str, Any] | None = None


def commanded_force(grip: Grip, time: Floats, actual: Floats) -> Floats:
    """Return the commanded force, (T,), N, while the control is active and all fingers touch; otherwise NaN.

    It increases from the actual force in the first row in which this holds; the control law uses the exact
    instant, which may lie between two rows. If the fingers are unknown, it is the desired force in all rows.

    Parameters
    ----------
    grip : Grip
        Control of the gripper.
    time : (T,) array
        Times, s.
    actual : (T,) array
        Mean normal forces of the fingers, N; NaN while the control is not active.
    """
    pressures = grip.pressures or {}
    touching = [np.any([pressures[name] > 0.0 for name in names], axis=0) for names in grip.fingers]
    if not touching:
        return np.full(time.shape, grip.force)
    closed = np.all(touching, axis=0) & np.isfinite(actual)
    commanded = np.full(time.shape, np.nan)
    starts = np.flatnonzero(closed & ~np.r_[False, closed[:-1]])
    for start in starts:
        stop = start + int(np.argmin(np.r_[closed[start:], False]))
        elapsed = time[start:stop] - time[start]
        risen = grip.force * elapsed / grip.ramp if grip.ramp > 0.0 else np.full(elapsed.shape, grip.force)
        commanded[start:stop] = np.minimum(actual[start] + risen, grip.force)
    return commanded


def grip_force(trace: Trace, name: str, grip: Grip) -> Figure:
    """Draw the mean normal force of the fingers of a control while it is active, and the commanded force.

    Parameters
    ----------
    trace : Trace
        Trace of the run.
    name : str
        Name of the control.
    grip : Grip
        The control.
    """
    time, label = clock(trace)
    error = np.asarray(trace.tracking[name])[:, 0]
    # the error is exactly zero while the control is not active
    active = error != 0.0
    actual = grip.force - error
    commanded = commanded_force(grip, np.asarray(trace.time), np.where(active, actual, np.nan))
    figure = new_figure(COLUMN, 2.2)
    axes = figure.subplots()
    axes.plot(time[active], actual[active], color=XYZ_COLORS[0], linewidth=LINE, label="grip force")
    axes.plot(
        time[active], commanded[active], color=INK, linewidth=LINE, linestyle=":", label="commanded"
    )  # fmt: skip
    tidy(axes, label, "force [N]")
    legend_above(axes)
    return figure
