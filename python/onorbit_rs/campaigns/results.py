"""Selects the columns that the report of a campaign shows, with labels, units and percentiles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from onorbit_rs.campaigns.statistics import numeric
from onorbit_rs.output.checks import CHECKS
from onorbit_rs.report.numbers import row

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

FIRST = ("case", "status", "success", "error")
_NOT_RESULTS = ("wall_s", "real_time_factor", "rows", "simulated_s", "time_step_s", *CHECKS)
_ORDER = ("tracking_", "control_", "events.", "clearance_", "base_", "contacts.", "joint_", "loop_")
"""Prefixes of the names of results, in the order of the report."""
_SMALLEST_SPREAD = 1e-9
"""Range of a column relative to its largest magnitude below which it counts as constant."""


class Result(NamedTuple):
    """A numeric column that varies between the cases; NaN where a case has no value."""

    key: str
    label: str
    unit: str
    values: Floats


def results(columns: dict[str, list[Any]], value_names: Sequence[str], first: Sequence[str]) -> list[Result]:
    """Return the results that vary; those named in ``first`` come first.

    Checks, relative errors, and the times and numbers of rows of the run are left out.
    """
    names = [name for name in columns if name not in FIRST and name not in value_names]
    found = []
    for name in names:
        last = name.rpartition(".")[2]
        if last in _NOT_RESULTS or "certificate" in name or last.endswith("_rel"):
            continue
        values = numeric(columns[name])
        if values is not None and _varies(values):
            found.append(_labelled(name, values))
    return sorted(found, key=lambda result: _rank(result.key, first))


def dispersed(columns: dict[str, list[Any]], value_names: Sequence[str]) -> list[Result]:
    """Return the dispersed values that are numbers and vary, in SI units, which their labels do not show."""
    found = ((name, numeric(columns[name])) for name in value_names)
    return [
        Result(name, name, "", values) for name, values in found if values is not None and _varies(values)
    ]


def _varies(values: Floats) -> bool:
    given = values[np.isfinite(values)]
    return len(given) > 1 and bool(np.ptp(given) > _SMALLEST_SPREAD * np.abs(given).max())


def _labelled(name: str, values: Floats) -> Result:
    """Return a result with the label of the report of a run, preceded by its system, contact or event."""
    owner, _, last = name.rpartition(".")
    described = row(last, True)  # the value True keeps the unit of the key, without an SI prefix
    owner = owner.removeprefix("systems.").removeprefix("events.").removeprefix("contacts.")
    return Result(name, f"{owner}: {described.name}" if owner else described.name, described.unit, values)


def _rank(key: str, first: Sequence[str]) -> tuple[int, int]:
    if key in first:
        return 0, list(first).index(key)
    parts = key.split(".")
    ends = [index for index, start in enumerate(_ORDER)
            if key.startswith(start) or parts[-1].startswith(start)]  # fmt: skip
    return 1, min(ends, default=len(_ORDER))


PERCENTILES = (0.0, 5.0, 50.0, 95.0, 100.0)


def percentile_rows(found: Sequence[Result], cases: Sequence[int]) -> Iterator[list[Any]]:
    """Yield label, unit, percentiles, and the case with the largest value of each result.

    ``cases`` are the numbers of the cases, in the order of the values.
    """
    for result in found:
        is_given = np.isfinite(result.values)
        given = result.values[is_given]
        numbers = [float(number) for number in np.percentile(given, PERCENTILES)]
        largest = cases[int(np.flatnonzero(is_given)[np.argmax(given)])]
        yield [result.label, result.unit, *numbers, largest]
