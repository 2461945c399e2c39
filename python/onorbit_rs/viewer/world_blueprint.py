"""Layout of the viewer for several systems: a common view, a view of each system, events, and plots."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import rerun.blueprint as rrb

from onorbit_rs.viewer.blueprint import axes_of_camera, orbit_view, scene_view, with_panels
from onorbit_rs.viewer.flight import flight_view
from onorbit_rs.viewer.frames import FOLLOW
from onorbit_rs.viewer.plots import plot_column, plots_in_groups, whole_run
from onorbit_rs.viewer.trace_rows import TIMELINE
from onorbit_rs.viewer.world_events import LOG, STATES
from onorbit_rs.viewer.world_series import SHARED
from onorbit_rs.viewer.world_viewpoint import is_near

if TYPE_CHECKING:
    from onorbit_rs.viewer.flight import Body
    from onorbit_rs.viewer.series import Series
    from onorbit_rs.viewer.viewpoint import Viewpoint
    from onorbit_rs.viewer.world_rows import WorldRows

_ALONE = ("arrows", "axes")
"""Parts of a system that only the view of this system shows; elsewhere they would cover other systems."""
_FIRST = (
    "position",
    "attitude",
    "contact_force",
    "angular_momentum_z",
    "kinetic_energy",
    "radial",
    "along_track",
    "cross_track",
    "distance",
)
"""Last parts of the paths of the plots in the overview."""
_MOST_IN_A_COLUMN = 4
_MOST_LANES = 6
"""Largest number of connections and contacts for which the timeline of their states grows."""
_APART = ("flight", "near")
"""Parts of a system that have separate views."""


def world_layout(
    world: WorldRows,
    viewpoints: tuple[Viewpoint, dict[str, Viewpoint]],
    bodies: list[Body],
    plots: Sequence[Series],
    duration_s: float,
    *,
    has_notes: bool,
    has_events: bool,
    is_live: bool = False,
) -> rrb.Blueprint:
    """Return the layout of a run with several systems, with a view of the relative flight of ``bodies``.

    Without bodies, this view is omitted.
    """
    setting, (common, alone) = world.setting, viewpoints
    settings, is_scene = list(setting.systems.values()), is_near(common, alone)
    axes = axes_of_camera(world.first)
    scenes = []
    if is_scene:
        name = f"{', '.join(setting.names)}: camera follows their centre of mass, axes of {axes}"
        scenes.append(scene_view(name, _contents(setting.names), FOLLOW, common, settings))
        if setting.contacts:
            contents = [*_contents(setting.names), *(f"- $origin/{name}/robot/**" for name in setting.names)]
            name = "Contacts: collision shapes, points and forces"
            scenes.append(scene_view(name, contents, FOLLOW, common, settings, has_collisions=True))
    flight = flight_view(bodies, _flight_contents(setting.names)) if bodies else None
    if flight is not None and not is_scene:
        scenes.append(flight)
    for system in settings:
        contents = _contents(setting.names, system.system)
        name = f"{system.system}: camera follows the base" if scenes else system.system
        scenes.append(scene_view(name, contents, system.frame(FOLLOW), alone[system.system], settings))
    below: list[rrb.View] = []
    if "position_eci" in world.first:
        below.append(orbit_view(world.first, settings))
    if flight is not None and is_scene:
        below.append(flight)
    if has_notes:
        below.append(rrb.TextDocumentView(origin="notes", name="Notes"))
    top = rrb.Tabs(*scenes, active_tab=0)
    left = rrb.Vertical(top, rrb.Horizontal(*below), row_shares=[5, 3]) if below else top
    right: rrb.Container = _plots(setting.names, plots, duration_s, is_live=is_live)
    lanes = {"Connections": len(setting.connections), "Contacts": len(setting.contacts)}
    if count := sum(lanes.values()):
        title = " and ".join(name for name, number in lanes.items() if number).capitalize()
        states = rrb.StateTimelineView(origin=STATES, name=title, time_view=whole_run(duration_s))
        parts: list[rrb.Container | rrb.View] = [right, states]
        shares = [8.0, 0.8 + 0.5 * min(count, _MOST_LANES)]
        if has_events:
            columns = rrb.TextLogColumns(timeline_columns=[TIMELINE], text_log_columns=["body"])
            parts.append(rrb.TextLogView(origin=LOG, name="Events", columns=columns))
            shares.append(1.6)
        right = rrb.Vertical(*parts, row_shares=shares)
    return with_panels(left, right, duration_s, is_live=is_live)


def _contents(names: Sequence[str], alone: str = "") -> list[str]:
    """Return the contents of a 3-D view of all systems; the system ``alone`` is shown with all parts."""
    found = ["$origin/**", "- $origin/lvlh/flight/**"]
    found += [f"- $origin/{name}/{part}/**" for name in names for part in _APART]
    found += [f"- $origin/{name}/{part}/**" for name in names if name != alone for part in _ALONE]
    return [*found, "- $origin/lvlh/**"] if alone else found


def _flight_contents(names: Sequence[str]) -> list[str]:
    """Return the contents of the view of the relative flight."""
    return ["$origin/lvlh/flight/**", *(f"$origin/{name}/flight/**" for name in names)]


def _plots(names: Sequence[str], plots: Sequence[Series], duration_s: float, *, is_live: bool) -> rrb.Tabs:
    """Return an overview, a tab for each group of plots of all systems, and a tab for each system."""
    shared = [series for series in plots if series.path.startswith(SHARED)]
    by_path = {series.path.rpartition("/")[2]: series for series in reversed(shared)}
    tabs = {"Overview": [by_path[name] for name in _FIRST if name in by_path][:_MOST_IN_A_COLUMN]}
    for series in shared:
        tabs.setdefault(series.group, []).append(series)
    found: list[rrb.Container] = []
    for group, members in tabs.items():
        found.append(plot_column(group, members, duration_s, is_live=is_live))
    for name in names:
        own = [series for series in plots if series.path.split("/")[1] == name]
        found.append(plots_in_groups(own, duration_s, is_live=is_live, system=name))
    return rrb.Tabs(*found, active_tab=0)
