"""A run as one HTML page that needs nothing else: figures, numbers, certificate, scenario, versions."""

from __future__ import annotations

from onorbit_rs.report.write import write_report

__all__ = ["write_report"]
