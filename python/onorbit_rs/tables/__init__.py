"""Recorded runs as tables: pandas, xarray, CSV, Parquet, and CCSDS ephemerides."""

from __future__ import annotations

from onorbit_rs.tables.recorded_run import RecordedRun, read_run

__all__ = ["RecordedRun", "read_run"]
