"""Figures of contacts: touches as bars, gaps on a scale that shows the depth, and the energy ledger."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from contact_worlds import pair, run
from world_runs import built, ran

from onorbit_rs import figures
from onorbit_rs.common.touches import touches_of
from onorbit_rs.figures.contact_energy import ledger_of
from onorbit_rs.figures.contact_overview import linear_part


@cache
def push() -> Any:
    """Returns the trace of a bundled run in which motors work and a contact dissipates."""
    return ran(built("push_and_drift"))


def test_bars_extend_from_touch_down_to_lift_off_and_gaps_show_the_depth() -> None:
    trace = push()
    figure = figures.contact_overview(trace, trace.events)
    upper, lower = figure.axes
    ((bar,),) = ([path.vertices for path in bars.get_paths()] for bars in upper.collections)
    down, up = (event.time for event in trace.events)
    np.testing.assert_allclose([bar[:, 0].min(), bar[:, 0].max()], [down, up], rtol=1e-12)
    assert [text.get_text() for text in upper.texts] == ["1 touch, 1.37 s"]
    assert lower.get_yscale() == "symlog" and lower.get_ylabel() == "gap [mm]"
    plotted = lower.lines[-1].get_ydata()
    np.testing.assert_allclose(np.min(plotted), 1e3 * trace.contacts["push"].gap.min(), rtol=1e-12)


def test_a_touch_that_goes_on_lasts_until_the_end() -> None:
    trace = push()
    assert touches_of(trace.events[:1], 10.0) == {"push": [(trace.events[0].time, 10.0)]}


def test_the_scale_of_gaps_is_linear_where_it_shows_everything() -> None:
    assert linear_part([np.array([1.0, 0.5])]) is None
    assert linear_part([np.array([1.0, -3e-4])]) == 1e-4
    assert linear_part([np.array([1.0, 0.4]), np.array([1.0, 2e-3])]) == 1e-3


def test_the_sum_of_the_ledger_is_constant_and_no_part_can_be_left_out() -> None:
    for trace, drawn in ((push(), True), (run(pair(), 0.2), False)):
        _, lines = ledger_of(trace, trace.names, trace.events)
        *parts, total = lines
        largest = max(np.abs(values).max() for values in lines.values())
        assert np.ptp(lines[total]) < 1e-9 * largest
        assert ("work of motors and environment" in lines) == drawn
        for part in parts:
            assert np.ptp(lines[total] - lines[part]) > 1e-3 * largest, part


def test_a_short_touch_is_enlarged_and_a_run_without_contacts_has_no_such_figures() -> None:
    trace = run(pair(), 0.5)
    names = tuple(trace.names)
    figure = figures.contact_energy(trace, names, trace.events)
    (start, end), (down, up) = figure.axes[1].get_xlim(), (event.time for event in trace.events)
    assert start < down < up < end and end - start < 2.0 * (up - down)
    single = ran(built("formation"))
    subject = figures.WorldSubject(single, {})
    found = {drawing.name for drawing in figures.world_drawings(subject)}
    assert not {name for name in found if "contact" in name or "ledger" in name}
