"""The orbit around the planet, and how the base turns in the local orbital frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec

from onorbit_rs.figures.space import add_space, fit, label
from onorbit_rs.figures.style import COLORS, XYZ_COLORS, legend_beside, new_figure, plot_lines, thin, tidy
from onorbit_rs.rotations import attitude_in_orbit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Trace

    Floats = NDArray[np.float64]

EARTH_RADIUS_KM = 6378.137


def orbit_overview(trace: Trace) -> Figure:
    """The path around the Earth (inertial axes, to scale), distance, attitude of the base relative to L."""
    position, velocity = np.asarray(trace.position_eci), np.asarray(trace.velocity_eci)
    angles = np.degrees(attitude_in_orbit(np.asarray(trace.q)[:, 3:7], position, velocity))
    distance_km = np.linalg.norm(position, axis=1)[:, None] / 1e3
    figure = new_figure(10.5, 4.6, "Orbit, and attitude of the base in the local orbital frame")
    grid = GridSpec(2, 2, figure=figure, width_ratios=(1.0, 1.15))
    _draw_path(figure, grid, position / 1e3)
    for row, (values, names, colors, y_label) in enumerate(
        [
            (distance_km, ("distance",), COLORS, "distance from the\nEarth's centre [km]"),
            (
                angles,
                ("roll (about x)", "pitch (about y)", "yaw (about z)"),
                XYZ_COLORS,
                "attitude\nrelative to L [deg]",
            ),
        ]
    ):
        axes = figure.add_subplot(grid[row, 1])
        plot_lines(axes, trace.time, values, names, colors)
        tidy(axes, "time [s]" if row else "", y_label)
        axes.ticklabel_format(axis="y", useOffset=False)
        if len(names) > 1:
            legend_beside(axes)
    return figure


def _draw_path(figure: Figure, grid: GridSpec, position_km: Floats) -> None:
    axes = add_space(figure, grid[:, 0], elevation=24.0, azimuth=35.0)
    longitude, latitude = np.meshgrid(np.linspace(0, 2 * np.pi, 37), np.linspace(-np.pi / 2, np.pi / 2, 19))
    sphere = EARTH_RADIUS_KM * np.stack(
        [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)]
    )
    axes.computed_zorder = False
    axes.plot_surface(*sphere, color="#CFE3F1", edgecolor="#A9C8DF", linewidth=0.3, shade=False, zorder=1)
    rows, _ = thin(np.arange(len(position_km), dtype=np.float64), position_km[:, 0])
    path = position_km[rows.astype(int)]
    hidden = _is_behind_the_planet(path, axes.elev, axes.azim)
    axes.plot(*np.where(hidden[:, None], np.nan, path).T, color=COLORS[1], linewidth=2.0, zorder=3)
    axes.plot(*path.T, color=COLORS[1], linewidth=0.8, linestyle=":", zorder=2)
    axes.scatter(*path[0], color=COLORS[1], s=30, depthshade=False, zorder=4, label="start")
    axes.legend(loc="upper left", frameon=False, fontsize=8)
    fit(axes, np.vstack([sphere.reshape(3, -1).T, path]), zoom=0.95)
    label(axes, "km", "inertial")


def _is_behind_the_planet(path_km: Floats, elevation_deg: float, azimuth_deg: float) -> NDArray[np.bool_]:
    """Whether each point (k, 3) is hidden from a far eye."""
    elevation, azimuth = np.radians([elevation_deg, azimuth_deg])
    eye = np.array(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    )
    along = path_km @ eye
    aside = np.linalg.norm(path_km - along[:, None] * eye, axis=1)
    hidden: NDArray[np.bool_] = (along < 0.0) & (aside < EARTH_RADIUS_KM)
    return hidden
