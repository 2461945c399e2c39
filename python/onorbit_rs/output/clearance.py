"""Distances and keep-out zones of a run: entries of the summary, warnings and arrays."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.clearance.evaluate import clearances
from onorbit_rs.clearance.watches import KeepOut, Watch
from onorbit_rs.scenario.build_world import BuiltWorld
from onorbit_rs.scenario.watches import build_watches

if TYPE_CHECKING:
    from onorbit_rs.clearance.evaluate import Clearance
    from onorbit_rs.clearance.intervals import Violation
    from onorbit_rs.scenario.build import Built

    Found = list[tuple[Watch, Clearance]]


def found_clearances(trace: Any, built: Built | BuiltWorld) -> Found:
    """Return the zones and distances of a scenario with their values in the rows of a trace."""
    if not built.scenario.keep_out and not built.scenario.distances:
        return []
    if isinstance(built, BuiltWorld):
        models = {name: alone.model for name, alone in built.systems.items()}
    else:
        models = {"": built.model}
    watches = build_watches(built.scenario, models)
    return list(zip(watches, clearances(models, trace, watches).values(), strict=True))


def add_clearances(summary: dict[str, Any], found: Found) -> None:
    """Add the least distances and their times to a summary; add and issue a warning for each violation."""
    messages = [line for line in summary["warnings"].split("\n") if line]
    for watch, values in found:
        row = values.nearest
        summary[f"clearance_{values.name}_min_m"] = float(values.gap[row])
        summary[f"clearance_{values.name}_min_time_s"] = float(values.time[row])
        for violation in values.violations:
            messages.append(_message(watch, violation))
            warnings.warn(messages[-1], stacklevel=2)
    summary["warnings"] = "\n".join(messages)


def _message(watch: Watch, violation: Violation) -> str:
    """Return the warning about a violation."""
    since = "the start" if violation.entry is None else f"{violation.entry:.6g} s"
    until = "the end" if violation.exit is None else f"{violation.exit:.6g} s"
    when = f"from {since} to {until}, up to {violation.depth:.3g} m deep at {violation.time:.6g} s"
    first, second = violation.links
    if isinstance(watch, KeepOut):
        return f"keep-out zone {watch.name!r}: {second!r} was inside {when}"
    return f"distance {watch.name!r}: {first!r} and {second!r} overlapped {when}"


def clearance_arrays(found: Found) -> dict[str, Any]:
    """Return columns (T, 12) by path: gap and points, m, normal, and indices of the nearest pair."""
    return {
        f"clearance_{values.name}": np.column_stack(
            [values.gap, values.point_a, values.point_b, values.normal, values.pair]
        )
        for _, values in found
    }
