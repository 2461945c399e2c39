"""Displays of objects in notebooks: a model as a tree, a run as a short report, a trace as a plot."""

from __future__ import annotations

from onorbit_rs.displays.fallback import or_plain
from onorbit_rs.displays.html import model_html, run_html, trace_png

__all__ = ["model_html", "or_plain", "run_html", "trace_png"]
