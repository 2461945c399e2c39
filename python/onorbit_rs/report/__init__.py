"""A run as one self-contained HTML page: figures, numbers, certificate, scenario, versions."""

from __future__ import annotations

from onorbit_rs.report.write import write_report

__all__ = ["write_report"]
