"""Figure of the gap, the forces, the sliding speed and the energies of a contact."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.display_units import ROUNDING, with_prefix
from onorbit_rs.figures.style import (
    COLORS,
    PAGE,
    hide_rounding,
    legend_above,
    new_figure,
    plot_lines,
    tidy,
    time_unit,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import ContactTrace, WorldTrace

    Floats = NDArray[np.float64]

MARGIN = 0.25
"""Time drawn before the first touch and after the last one, as a fraction of the time between both."""


def contact_history(trace: WorldTrace, name: str) -> Figure:
    """Draw gap, normal force and friction, sliding speed, and energies of a contact while its sides touch.

    Parameters
    ----------
    trace : WorldTrace
        Trace of the run.
    name : str
        Name of the contact.
    """
    contact = trace.contacts[name]
    owner = next(system for system in trace.names if name in trace[system].contacts)
    rows = rows_of_touch(np.asarray(trace[owner].time), contact)
    times = np.asarray(trace[owner].time)[rows]
    force = np.asarray(contact.force)[rows]
    pressure = np.einsum("ti,ti->t", force, np.asarray(contact.normal)[rows])
    friction = np.sqrt(np.maximum(np.sum(force**2, axis=1) - pressure**2, 0.0))
    scale, clock = time_unit(times)
    panels = (
        ("gap", "gap", {"gap": np.asarray(contact.gap)[rows]}),
        ("force", "force", {"normal": pressure, "friction": friction}),
        ("sliding speed", "sliding_speed", {"slip": np.asarray(contact.slip)[rows]}),
        ("energy", "elastic", {what: np.asarray(getattr(contact, what))[rows]
                               for what in ("elastic", "dissipated")}),
    )  # fmt: skip
    figure = new_figure(PAGE, 3.9)
    for number, (axes, (title, part, lines)) in enumerate(
        zip(figure.subplots(2, 2, sharex=True).flat, panels, strict=True)
    ):
        shown = _draw(axes, times / scale, lines, COLUMNS["contacts"].parts[part][1])
        tidy(axes, f"time [{clock}]" if number > 1 else "", f"{title} [{shown}]")
        if len(lines) > 1:
            legend_above(axes)
    return figure


def rows_of_touch(time: Floats, contact: ContactTrace) -> NDArray[np.int64]:
    """Return the indices of the rows from shortly before the first touch to shortly after the last one.

    If the sides never touch, these are all rows.
    """
    touch = np.flatnonzero(np.any(np.asarray(contact.force) != 0.0, axis=1))
    if not len(touch):
        return np.arange(len(time))
    first, last = time[touch[0]], time[touch[-1]]
    margin = MARGIN * (last - first)
    return np.flatnonzero((time >= first - margin) & (time <= last + margin))


def _draw(axes: Axes, time: Floats, lines: dict[str, Floats], unit: str) -> str:
    """Draw lines with one unit; return the unit with its prefix."""
    values = np.stack(list(lines.values()), axis=1)
    factor, shown = with_prefix(float(np.abs(values).max(initial=0.0)), unit)
    colors: Sequence[str] = COLORS
    plot_lines(axes, time, factor * values, tuple(lines), colors)
    hide_rounding(axes, ROUNDING * max(factor, 1.0))
    return shown
