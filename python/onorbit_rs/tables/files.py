"""Writes the rows of a run as CSV and Parquet."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

from onorbit_rs.common.files import replacing
from onorbit_rs.tables.extra import required

if TYPE_CHECKING:
    from onorbit_rs.tables.recorded_run import RecordedRun


def write_csv(run: RecordedRun, file: Path, system: str | None = None) -> None:
    """Write a CSV file with one line per row, and a header with units, such as ``tau/elbow [N m]``.

    Numbers have all their digits, so that reading them returns the same bits.

    Raises
    ------
    InputError
        As for :meth:`RecordedRun.columns`.
    OutputFolderError
        If the file cannot be written.
    """
    labels, rows = run.table(system)
    with replacing(file) as temporary, temporary.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow([f"{label.name} [{label.unit}]" for label in labels])
        writer.writerows(rows.tolist())


def write_parquet(run: RecordedRun, file: Path, system: str | None = None) -> None:
    """Write a Parquet file with a column per number; each column has its unit as metadata.

    Raises
    ------
    NotFoundError
        If pyarrow is not installed.
    InputError
        As for :meth:`RecordedRun.columns`.
    OutputFolderError
        If the file cannot be written.
    """
    arrow, parquet = required("pyarrow", "Parquet"), required("pyarrow.parquet", "Parquet")
    labels, rows = run.table(system)
    fields = [arrow.field(label.name, arrow.float64(), metadata={"unit": label.unit}) for label in labels]
    scenario = {"scenario": str(run.summary.get("scenario", ""))}
    table = arrow.table(
        [arrow.array(column) for column in rows.T], schema=arrow.schema(fields, metadata=scenario)
    )
    with replacing(file) as temporary:
        parquet.write_table(table, temporary)
