"""Figures of a run: the paper's Fig. 4-7, the motion of the base, conservation, the orbit.

Each is a function that takes a trace and returns a ``matplotlib.figure.Figure``; nothing global is touched.
This folder alone imports matplotlib.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from onorbit_rs.figures.differences import differences
from onorbit_rs.figures.motion import base_motion, conservation
from onorbit_rs.figures.orbit import orbit_overview
from onorbit_rs.figures.tracking import joint_torques, tracking_errors
from onorbit_rs.figures.trajectory import desired_trajectory, obtained_trajectory
from onorbit_rs.rotations import has_local_frame

if TYPE_CHECKING:
    from onorbit_rs._core import Model, Trace

__all__ = [
    "base_motion",
    "conservation",
    "desired_trajectory",
    "differences",
    "joint_torques",
    "obtained_trajectory",
    "orbit_overview",
    "save_all",
    "tracking_errors",
]

WORTH_AN_ORBIT_DEG = 5.0
"""Angle flown around the planet from which the orbit is drawn."""


def save_all(trace: Trace, model: Model, folder: Path, *, has_planet: bool = True) -> list[Path]:
    """Write every figure that this trace has the columns for.

    Parameters
    ----------
    trace : Trace
    model : Model
    folder : Path
        Made where missing.
    has_planet : bool
        Whether the orbit, if any, is around a planet: else it is not drawn around one.

    Returns
    -------
    list of Path
        The PNG files.
    """
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for name, draw in _fitting(trace, model, has_planet):
        files.append(folder / f"{name}.png")
        draw().savefig(files[-1])
    return files


def _fitting(trace: Trace, model: Model, has_planet: bool) -> Iterator[tuple[str, Callable[[], Figure]]]:
    columns = set(trace.columns())
    if "reference_pose" in columns:
        yield "fig4_desired_trajectory", lambda: desired_trajectory(trace, model)
        yield "fig5_obtained_trajectory", lambda: obtained_trajectory(trace)
        yield "fig6_tracking_errors", lambda: tracking_errors(trace)
    if model.joint_names and np.any(trace.tau):
        yield "fig7_joint_torques", lambda: joint_torques(trace, model)
    yield "base_motion", lambda: base_motion(trace)
    yield "conservation", lambda: conservation(trace)
    if has_planet and has_local_frame(trace) and _angle_flown_deg(trace) > WORTH_AN_ORBIT_DEG:
        yield "orbit", lambda: orbit_overview(trace)


def _angle_flown_deg(trace: Trace) -> float:
    """Largest angle (degrees) between the first direction from the planet's centre and any other."""
    direction = np.asarray(trace.position_eci)
    direction = direction / np.linalg.norm(direction, axis=1, keepdims=True)
    return float(np.degrees(np.arccos(np.clip(direction @ direction[0], -1.0, 1.0)).max()))
