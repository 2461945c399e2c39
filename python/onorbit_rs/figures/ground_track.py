"""Figure of the ground track of a run on the Earth."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onorbit_rs.common.decimate import evenly_spaced
from onorbit_rs.figures.style import (
    COLORS,
    INK,
    LINE,
    OBTAINED,
    PAGE,
    clock,
    legend_above,
    new_figure,
    tidy,
)
from onorbit_rs.visuals.land import centers, smooth_land

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Earth, Trace

    Floats = NDArray[np.float64]

_MOST_ROWS = 3_000
LEAST_PER_REVOLUTION = 40
"""Smallest number of points per revolution for which a line is drawn; fewer points are drawn as dots."""

_LAND, _COAST = "#eceae4", "#9a978f"

LOCAL_DEG = 20.0
"""Extent of a track, degrees, below which only its surroundings are drawn (geostationary orbits)."""


def ground_track(trace: Trace, earth: Earth) -> Figure:
    """Draw geodetic longitude and latitude of the base, with coastlines, and its height above the ellipsoid.

    The track is a line. If the run has fewer than :data:`LEAST_PER_REVOLUTION` points per revolution, the
    track is drawn as dots, whose spacing in time is in the legend.
    """
    time, label = clock(trace)
    rows = evenly_spaced(len(time), _MOST_ROWS)
    position = np.ascontiguousarray(np.asarray(trace.position_eci)[rows])
    latitude, longitude, height = earth.geodetic(np.ascontiguousarray(trace.time[rows]), position)
    lat, lon = np.degrees(latitude), (np.degrees(longitude) + 180.0) % 360.0 - 180.0
    lon = unwrapped if np.ptp(unwrapped := np.unwrap(lon, period=360.0)) < LOCAL_DEG else lon
    figure = new_figure(PAGE, 2.6)
    world, profile = figure.subplots(1, 2, width_ratios=(2.0, 1.0))
    _add_land(world)
    style: dict[str, Any] = {"color": COLORS[0], "linewidth": LINE}
    if len(rows) < LEAST_PER_REVOLUTION * _revolutions(trace):
        apart = float(trace.time[rows[-1]] - trace.time[rows[0]]) / (len(rows) - 1)
        style = {"color": COLORS[0], "linestyle": "none", "marker": ".", "markersize": 1.5}
        world.plot(lon, lat, label=f"a dot every {_span(apart)}", **style)
    else:
        world.plot(*_broken_at_the_date_line(lon, lat), **style)
    # a ring, so that the end of the run is visible even at the same point
    world.plot(lon[0], lat[0], "o", color="none", markeredgecolor=INK, markersize=7, label="start")
    world.plot(lon[-1], lat[-1], "s", color=OBTAINED, markersize=3, label="end")
    tidy(world, "longitude, east [deg]", "geodetic latitude [deg]")
    world.axhline(0.0, color=INK, linewidth=0.5)
    _set_window(world, lon, lat)
    legend_above(world)
    profile.plot(time[rows], height / 1e3, **style)
    tidy(profile, label, "height [km]")
    profile.ticklabel_format(axis="y", useOffset=False)
    return figure


def _add_land(world: Axes) -> None:
    """Draw land with its coastlines; it is repeated beyond the date line for small tracks that cross it."""
    latitude, longitude = centers()
    every = 2  # cells of one degree
    share = smooth_land()[::every, ::every]
    wide = np.concatenate([longitude[::every] - 360.0, longitude[::every], longitude[::every] + 360.0])
    land = np.tile(share, (1, 3))
    kept = np.abs(wide) < 180.0 + LOCAL_DEG
    world.contourf(wide[kept], latitude[::every], land[:, kept], levels=[0.5, 1.1], colors=[_LAND])
    world.contour(wide[kept], latitude[::every], land[:, kept], levels=[0.5], colors=[_COAST], linewidths=0.3)


def _set_window(world: Axes, lon: Floats, lat: Floats) -> None:
    """Set the limits of the map: the whole Earth, or the surroundings of a small track."""
    sides = np.ptp(lon), np.ptp(lat)
    if max(sides) >= LOCAL_DEG:
        world.set(xlim=(-180.0, 180.0), ylim=(-90.0, 90.0), aspect="equal")
        world.set_xticks(range(-180, 181, 60))
        world.set_yticks(range(-90, 91, 30))
        return
    half = max(0.3 * sides[0], 0.6 * sides[1], 0.01)
    x, y = ((one.max() + one.min()) / 2.0 for one in (lon, lat))
    world.set(xlim=(x - 2.0 * half, x + 2.0 * half), ylim=(y - half, y + half), aspect="equal")
    world.ticklabel_format(useOffset=False)
    world.locator_params(nbins=5)


def _revolutions(trace: Trace) -> float:
    """Return the number of revolutions by integrating `|r × v| / r²`; rows may be revolutions apart."""
    r, v = np.asarray(trace.position_eci), np.asarray(trace.velocity_eci)
    rate = np.linalg.norm(np.cross(r, v), axis=1) / np.einsum("ti,ti->t", r, r)
    return float(np.trapezoid(rate, trace.time)) / (2.0 * np.pi)


def _span(seconds: float) -> str:
    """Return a time span with a suitable unit as text."""
    return f"{seconds:.3g} s" if seconds < 120.0 else f"{seconds / 60.0:.3g} min"


def _broken_at_the_date_line(lon: Floats, lat: Floats) -> tuple[Floats, Floats]:
    """Return longitude and latitude, deg, with a gap (NaN) where the track crosses the date line."""
    at = np.flatnonzero(np.abs(np.diff(lon)) > 180.0) + 1
    return np.insert(lon, at, np.nan), np.insert(lat, at, np.nan)
