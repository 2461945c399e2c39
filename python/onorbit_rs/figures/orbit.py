"""Figure of the orbit around the planet, and of the attitude of the base in the local orbital frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from onorbit_rs.common.coordinates import QUATERNION
from onorbit_rs.common.display_units import ROUNDING_DEG, degrees_with_prefix, with_prefix
from onorbit_rs.common.rotations import attitude_in_orbit
from onorbit_rs.figures.space import add_space, fit, label
from onorbit_rs.figures.style import (
    COLORS,
    OBTAINED,
    PAGE,
    SMALL,
    XYZ_COLORS,
    clock,
    hide_rounding,
    legend_above,
    new_figure,
    plot_lines,
    thin,
    tidy,
)
from onorbit_rs.visuals.earth_shape import EARTH_RADIUS_KM

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]

NEARLY_ROUND = 1e-5
"""Relative change of the distance from the planet's centre below which only the change is drawn."""


def orbit_overview(trace: Trace, *, is_earth: bool = True) -> Figure:
    """Draw the path around the planet, the distance from its centre, and the attitude of the base in L.

    The path is to scale in inertial axes. L is the local orbital frame of the reference orbit. The radius of
    a planet other than the Earth is unknown; such a planet is drawn as a small sphere.
    """
    position = np.asarray(trace.position_eci)
    quat, reference = np.asarray(trace.q)[:, QUATERNION], trace.reference_position_eci
    angles = np.degrees(attitude_in_orbit(quat, reference, trace.reference_velocity_eci))
    distance_km = np.linalg.norm(position, axis=1)[:, None] / 1e3
    time, clock_label = clock(trace)
    figure = new_figure(PAGE, 3.2)
    grid = figure.add_gridspec(2, 2, width_ratios=(0.8, 1.0))
    _draw_path(figure, position / 1e3, is_earth)
    upper, lower = figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1])
    whose = f"distance from the\n{'Earth' if is_earth else 'planet'}'s centre"
    if np.ptp(distance_km) < NEARLY_ROUND * distance_km[0, 0]:  # keeps tick labels short
        whose, distance_km = f"distance minus\n{distance_km[0, 0]:.3f} km", distance_km - distance_km[0, 0]
    factor, unit = with_prefix(1e3 * float(np.abs(distance_km).max()), "m")
    factor, unit = (1e-3, "km") if "minus" not in whose else (factor, unit)
    plot_lines(upper, time, 1e3 * factor * distance_km, ("distance",), COLORS)
    turn, turned = degrees_with_prefix(float(np.abs(angles).max()))
    plot_lines(lower, time, turn * angles, ("roll", "pitch", "yaw"), XYZ_COLORS)
    hide_rounding(lower, ROUNDING_DEG * turn)
    tidy(upper, "", f"{whose} [{unit}]")
    tidy(lower, clock_label, f"attitude\nrelative to L [{turned}]")
    for axes in (upper, lower):  # matplotlib's offset text would overlap the legend
        axes.ticklabel_format(axis="y", useOffset=False)
    upper.tick_params(labelbottom=False)
    legend_above(lower)
    figure.align_ylabels([upper, lower])
    return figure


def _draw_path(figure: Figure, position_km: Floats, is_earth: bool) -> None:
    axes = add_space(figure, (0.035, 0.07, 0.385, 0.92), elevation=24.0, azimuth=35.0)
    longitude, latitude = np.meshgrid(np.linspace(0, 2 * np.pi, 37), np.linspace(-np.pi / 2, np.pi / 2, 19))
    radius = EARTH_RADIUS_KM if is_earth else 0.05 * float(np.linalg.norm(position_km, axis=1).max())
    sphere = radius * np.stack(
        [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)]
    )
    axes.computed_zorder = False
    axes.plot_surface(*sphere, color="#CFE3F1", edgecolor="#A9C8DF", linewidth=0.2, shade=False, zorder=1)
    rows, _ = thin(np.arange(len(position_km), dtype=np.float64), position_km[:, 0])
    path = position_km[rows.astype(int)]
    hidden = _is_behind(path, axes.elev, axes.azim, radius)
    axes.plot(*np.where(hidden[:, None], np.nan, path).T, color=OBTAINED, linewidth=1.4, zorder=3)
    axes.plot(*path.T, color=OBTAINED, linewidth=0.6, linestyle=":", zorder=2)
    face = "none" if hidden[0] else OBTAINED
    axes.scatter(*path[0], edgecolor=OBTAINED, facecolor=face, s=16, depthshade=False, zorder=4)
    axes.text(*path[0], "  start", color=OBTAINED, fontsize=SMALL, zorder=4)
    everything = np.vstack([sphere.reshape(3, -1).T, path])
    fit(axes, everything, room=(1.38, 1.5), least=0.4)
    label(axes, "km", pad=0.0)


def _is_behind(
    path_km: Floats, elevation_deg: float, azimuth_deg: float, radius_km: float
) -> NDArray[np.bool_]:
    """Return whether the planet hides each point (k, 3) from a distant viewer."""
    elevation, azimuth = np.radians([elevation_deg, azimuth_deg])
    to_viewer = np.array(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    )
    along = path_km @ to_viewer
    aside = np.linalg.norm(path_km - along[:, None] * to_viewer, axis=1)
    hidden: NDArray[np.bool_] = (along < 0.0) & (aside < radius_km)
    return hidden
