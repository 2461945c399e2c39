"""Table of a campaign: one row per case, as an Arrow table and a Parquet file."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from onorbit_rs.campaigns.cases import Outcome
from onorbit_rs.campaigns.document import Condition
from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import InputError, OnOrbitError

if TYPE_CHECKING:
    import pyarrow as pa

FIRST = ("case", "status", "success", "error")
"""Columns before the dispersed values."""


def arrow() -> Any:
    """Return the module pyarrow; raise InputError if it is not installed."""
    try:
        import pyarrow
    except ImportError:
        raise InputError(
            "a campaign requires pyarrow; install it with: pip install 'onorbit-rs[campaign]'",
            name="pyarrow",
        ) from None
    return pyarrow


def is_success(outcome: Outcome, conditions: dict[str, Condition]) -> bool:
    """Return True if a case is complete, its certificate passed, and all conditions hold."""
    if outcome.status != "complete" or not outcome.numbers.get("certificate_passed"):
        return False
    values = outcome.values | outcome.numbers
    return all(condition.holds(values.get(name)) for name, condition in conditions.items())


OF_EVENTS = ("events.", "certificate.")
"""Prefixes of columns that a case lacks if an event did not happen."""


def check_conditions(
    known: Sequence[str], conditions: dict[str, Condition], accepted: tuple[str, ...] = OF_EVENTS
) -> None:
    """Raise InputError, with a similar name if there is one, if a condition names no ``known`` column.

    Names that begin with one of ``accepted`` are not checked.
    """
    for name in conditions:
        if name not in known and not name.startswith(accepted):
            raise InputError(
                f"campaign.success: the results have no column {name!r}"
                f"{did_you_mean(name, known) or '; give the name of a column in cases.parquet'}",
                name=name, got=name, expected=nearest(name, known),
            )  # fmt: skip


def rows_of(
    outcomes: Iterable[Outcome], value_names: Sequence[str], conditions: dict[str, Condition]
) -> dict[str, list[Any]]:
    """Return the columns of the table as lists, in the order of the cases; None for a missing value.

    The columns are ``case``, ``status``, ``success``, ``error``, the dispersed values, and the numbers of the
    summaries in the order in which they first occur.
    """
    ordered = sorted(outcomes, key=lambda outcome: outcome.case)
    names = dict.fromkeys(name for outcome in ordered for name in outcome.numbers)
    columns: dict[str, list[Any]] = {
        "case": [outcome.case for outcome in ordered],
        "status": [outcome.status for outcome in ordered],
        "success": [is_success(outcome, conditions) for outcome in ordered],
        "error": [outcome.error for outcome in ordered],
    }
    columns |= {name: [outcome.values.get(name) for outcome in ordered] for name in value_names}
    return columns | {name: [outcome.numbers.get(name) for outcome in ordered] for name in names}


def table_of(columns: dict[str, list[Any]]) -> pa.Table:
    """Return the columns as an Arrow table: integers, floats, truth values and text."""
    pa = arrow()
    return pa.table({name: _array(pa, name, values) for name, values in columns.items()})


def _array(pa: Any, name: str, values: list[Any]) -> Any:
    kinds = {type(value) for value in values if value is not None}
    if name in ("status", "error"):
        return pa.array(values, pa.string())
    if kinds <= {bool} and kinds:
        return pa.array(values, pa.bool_())
    if kinds <= {int} and kinds:
        return pa.array(values, pa.int64())
    if kinds <= {int, float}:
        return pa.array([None if value is None else float(value) for value in values], pa.float64())
    texts = [value if value is None or isinstance(value, str) else json.dumps(value) for value in values]
    return pa.array(texts, pa.string())


def write_table(table: pa.Table, file: Path) -> None:
    """Write a table as Parquet; an OSError has the path of the file."""
    arrow()
    import pyarrow.parquet as pq

    try:
        pq.write_table(table, file, compression="zstd")
    except OSError as error:
        if isinstance(error, OnOrbitError):
            raise
        raise OSError(error.errno, error.strerror or str(error), str(file)) from error
