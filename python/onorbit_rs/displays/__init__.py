"""Displays of objects in notebooks: models, worlds, simulations, runs, traces and campaigns."""

from __future__ import annotations

from onorbit_rs.displays.fallback import or_plain
from onorbit_rs.displays.html import model_html, run_html, trace_png
from onorbit_rs.displays.world import simulation_html, world_html

__all__ = ["model_html", "or_plain", "run_html", "simulation_html", "trace_png", "world_html"]
