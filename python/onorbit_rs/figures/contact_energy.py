"""Figure of the energies of a group of systems before, during and after contacts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.common.display_units import ROUNDING, with_prefix
from onorbit_rs.common.event_kinds import OF_CONTACT
from onorbit_rs.common.group_momentum import shared_rows
from onorbit_rs.common.touches import touches_of
from onorbit_rs.figures.event_marks import of_systems
from onorbit_rs.figures.style import (
    COLORS,
    INK,
    PAGE,
    hide_rounding,
    legend_of_figure,
    new_figure,
    plot_lines,
    tidy,
    time_unit,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import WorldTrace
    from onorbit_rs.figures.world_subject import EventMark

    Floats = NDArray[np.float64]

MARGIN = 0.3
"""Time drawn before and after a touch, as a fraction of its duration."""
SHORT = 0.25
"""Longest touch, as a fraction of the run, that has an enlarged panel."""
WORTH_SHOWING = 1e-6
"""Smallest work that is drawn, as a fraction of the largest energy."""
SUM = "sum"


def contact_energy(trace: WorldTrace, systems: Sequence[str], events: Sequence[EventMark] = ()) -> Figure:
    """Draw the energies of a group of systems, the work of motors and environment, and the constant sum.

    If the touch with the largest elastic energy is short, a second panel shows the changes since the touch
    began.

    Parameters
    ----------
    trace : WorldTrace
        Trace of the run.
    systems : sequence of str
        Names of the systems of the group.
    events : sequence of EventMark
        Events of the run.
    """
    time, lines = ledger_of(trace, systems, events)
    touch = _largest_touch(time, lines["elastic"], events, list(_contacts(trace, systems)))
    is_short = touch is not None and touch[1] - touch[0] < SHORT * (time[-1] - time[0])
    figure = new_figure(PAGE, 2.7)
    whole, *close = figure.subplots(1, 2 if is_short else 1, squeeze=False)[0]
    _draw(whole, time, lines, "energy")
    for axes in close:
        assert touch is not None
        margin = MARGIN * (touch[1] - touch[0])
        rows = (time >= touch[0] - margin) & (time <= touch[1] + margin)
        at = int(np.argmax(time >= touch[0]))
        _draw(axes, time[rows], {name: (own - own[at])[rows] for name, own in lines.items()},
              "change since touch-down")  # fmt: skip
    legend_of_figure(figure, whole)
    return figure


def ledger_of(
    trace: WorldTrace, systems: Sequence[str], events: Sequence[EventMark] = ()
) -> tuple[Floats, dict[str, Floats]]:
    """Return the times common to the systems, (T,) s, and by name the energies of the group, (T,) J.

    The recorded work of a system is that of motors, springs at joints, environment and contacts, minus the
    energy lost in joints and in events such as captures. The energy that contacts absorb is stored as
    elastic energy or dissipated, so the work of motors and environment is
    `W - W_0 + Σ (U + D) - Σ (U_0 + D_0) + L`, with the recorded work `W`, the elastic energy `U` and the
    dissipated energy `D` of each contact and spring (`D = 0`) and the energy `L` lost in events; `0` denotes
    the first row. The last entry is the sum of the energies, minus this work.
    """
    times = [np.asarray(trace[name].time) for name in systems]
    rows = shared_rows(times)
    time = times[0][rows[0]]
    kinetic, recorded = (
        sum((np.asarray(getattr(trace[name], column))[own] for name, own in zip(systems, rows, strict=True)),
            start=np.zeros(len(time)))
        for column in ("kinetic_energy", "work")
    )  # fmt: skip
    elastic, dissipated = np.zeros(len(time)), np.zeros(len(time))
    for name, owner in _contacts(trace, systems).items():
        own = rows[list(systems).index(owner)]
        elastic += np.asarray(trace.contacts[name].elastic)[own]
        dissipated += np.asarray(trace.contacts[name].dissipated)[own]
    for name, own in zip(systems, rows, strict=True):
        if (stored := trace[name].spring_energy) is not None:
            elastic += np.asarray(stored)[own]
    taken, lost = elastic + dissipated, np.zeros(len(time))
    jumps = [event for event in of_systems(events, systems) if event.kind not in OF_CONTACT]
    for event in jumps:  # the second of the two rows at this time is the one after the event
        lost[np.searchsorted(time, event.time, side="right") - 1 :] += event.energy_lost
    work = recorded - recorded[0] + taken - taken[0] + lost
    lines = {"kinetic": kinetic, "elastic": elastic, "dissipated": dissipated}
    balance = kinetic + taken + lost - work
    if np.abs(work).max() > WORTH_SHOWING * max(float(np.abs(own).max()) for own in lines.values()):
        lines["work of motors and environment"] = work
    if jumps:
        lines["lost in events"] = lost
    name = f"{SUM} less the work" if "work of motors and environment" in lines else SUM
    return time, lines | {name: balance}


def _contacts(trace: WorldTrace, systems: Sequence[str]) -> dict[str, str]:
    """Return the system that records each contact of a group, by the name of the contact."""
    return {name: system for system in systems for name in trace[system].contacts}


def _largest_touch(
    time: Floats, elastic: Floats, events: Sequence[EventMark], contacts: Sequence[str]
) -> tuple[float, float] | None:
    """Return start and end, s, of the touch during which the elastic energy is largest, or None."""
    at = float(time[np.argmax(elastic)])
    found = touches_of(events, float(time[-1]))
    within = (touch for name in contacts for touch in found.get(name, ()) if touch[0] <= at <= touch[1])
    return next(within, None)


def _draw(axes: Axes, time: Floats, lines: Mapping[str, Floats], what: str) -> None:
    """Draw energies, J, over time in a unit that suits them; the last one, the sum, is dashed."""
    scale, clock = time_unit(time)
    factor, unit = with_prefix(max(float(np.abs(values).max()) for values in lines.values()), "J")
    columns = factor * np.stack(list(lines.values()), axis=1)
    plot_lines(axes, time / scale, columns, tuple(lines), (*COLORS[: len(lines) - 1], INK))
    axes.lines[-1].set_linestyle((0, (3, 1.5)))
    hide_rounding(axes, ROUNDING * max(factor, 1.0))
    tidy(axes, f"time [{clock}]", f"{what} [{unit}]")
