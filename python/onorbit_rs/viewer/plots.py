"""Plots beside the 3-D view: an overview, and a tab for each group."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import rerun.blueprint as rrb

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.viewer.series import Series

    Floats = NDArray[np.float64]

_FIRST = (
    "plots/tool_position_error",
    "plots/tool_attitude_error",
    "plots/joint_torque",
    "plots/base_attitude",
    "plots/slide_force",
)
_FIRST_WITHOUT_TOOL = (
    "plots/base_attitude_lvlh",
    "plots/base_rate",
    "plots/drag/force",
    "plots/gravity_gradient/torque",
    "plots/angular_momentum",
    "plots/joint_position",
    "plots/slide_position",
    "plots/base_attitude",
    "plots/energy",
)
_MOST_IN_A_COLUMN = 4
_LOW = 4
"""Smallest relative height of a plot, which suffices for this number of lines."""

_MOST_TICKS = 6.0
"""Largest number of labelled ticks in a low plot."""

_FOR_LEGENDS = 1.24
"""Length of the time axis in units of the run; the space after the run is for the legend."""


def plots_in_groups(
    plots: Sequence[Series], duration_s: float, *, is_live: bool, system: str = ""
) -> rrb.Tabs:
    """Return an overview, and a tab for each group; ``system`` is the name of the plots' system, if any."""
    by_path = {plot.path.replace(f"/{system}/", "/", 1): plot for plot in plots}
    wanted = _FIRST if _FIRST[0] in by_path else _FIRST_WITHOUT_TOOL
    first = [by_path[path] for path in wanted if path in by_path][:_MOST_IN_A_COLUMN]
    tabs = {"Overview": first}
    for plot in plots:
        tabs.setdefault(plot.group, []).append(plot)
    columns = [plot_column(name, group, duration_s, is_live=is_live) for name, group in tabs.items()]
    return rrb.Tabs(*columns, active_tab=0, name=system or None)


def plot_column(name: str, group: Sequence[Series], duration_s: float, *, is_live: bool) -> rrb.Vertical:
    """Return the plots of a group in one column."""
    return rrb.Vertical(
        *(_plot(plot, duration_s, is_live=is_live) for plot in group),
        row_shares=[min(max(_LOW, len(plot.names)), 9) for plot in group],
        name=name,
    )


def whole_run(duration_s: float) -> rrb.TimeAxis:
    """Return a time axis over the whole run, with space for the legend."""
    whole = rrb.TimeRange(
        start=rrb.TimeRangeBoundary.absolute(seconds=0.0),
        end=rrb.TimeRangeBoundary.absolute(seconds=_FOR_LEGENDS * duration_s),
    )
    return rrb.TimeAxis(view_range=whole)


def _plot(series: Series, duration_s: float, *, is_live: bool) -> rrb.TimeSeriesView:
    """Return a plot over the whole run."""
    is_low = len(series.names) <= _LOW
    return rrb.TimeSeriesView(
        origin=series.path,
        name=f"{series.title} [{series.unit}]",
        axis_x=whole_run(duration_s),
        axis_y=rrb.ScalarAxis(range=None if is_live or not is_low else with_two_ticks(series.values)),
        plot_legend=rrb.PlotLegend(rrb.Corner2D.RightTop),
    )


def with_two_ticks(values: Floats) -> tuple[float, float] | None:
    """Return a value range with two labelled ticks for a low plot; None if the default range is better.

    The default range is better if it has two ticks, or if the values are constant or not finite.

    Rerun places ticks only at multiples of powers of ten, and omits ticks that are close to each other.
    """
    low, high = float(values.min(initial=np.inf)), float(values.max(initial=-np.inf))
    if not 0.0 < high - low < np.inf:
        return None
    step = 10.0 ** math.ceil(math.log10((high - low) / _MOST_TICKS))
    below, above = step * math.floor(low / step), step * math.ceil(high / step)
    inside = math.floor(high / step) - math.ceil(low / step) + 1
    if inside > 1:
        return None
    if (
        inside == 1 and above - below > 1.5 * step
    ):  # extending the range to the nearer of the two adjacent ticks suffices
        below, above = (low, above) if above - high <= low - below else (below, high)
    margin = 0.05 * (above - below)
    return below - margin, above + margin
