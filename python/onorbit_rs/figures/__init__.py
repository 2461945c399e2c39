"""Figures of runs, comparisons and campaigns.

They include Fig. 4-7 of the OnOrbitROS paper, base reaction, momentum, energy, environment, orbit, contacts
and closed loops. Each figure is drawn by a function that returns a ``matplotlib.figure.Figure`` and changes
no global state. Only this folder imports matplotlib.
"""

from __future__ import annotations

from onorbit_rs.figures.campaign import (
    Series,
    correlation_map,
    result_distributions,
    strongest_pairs,
    success_history,
)
from onorbit_rs.figures.captured_motion import captured_motion
from onorbit_rs.figures.contact_energy import contact_energy
from onorbit_rs.figures.contact_history import contact_history
from onorbit_rs.figures.contact_overview import contact_overview
from onorbit_rs.figures.differences import differences
from onorbit_rs.figures.drawings import Drawing, drawings
from onorbit_rs.figures.forces import environment_forces
from onorbit_rs.figures.ground_track import ground_track
from onorbit_rs.figures.ledger import ledger
from onorbit_rs.figures.loop_history import loop_history
from onorbit_rs.figures.manipulability import manipulability
from onorbit_rs.figures.motion import base_motion, base_reaction
from onorbit_rs.figures.orbit import orbit_overview
from onorbit_rs.figures.portrait import portrait
from onorbit_rs.figures.relative import relative_motion
from onorbit_rs.figures.save import as_bytes, save, save_all
from onorbit_rs.figures.shared_balance import energy_exchange, momentum_exchange
from onorbit_rs.figures.style import COLUMN, PAGE
from onorbit_rs.figures.subject import Subject, Tool, subject_of, with_fingers
from onorbit_rs.figures.tracking import control_errors, joint_torques, tracking_errors
from onorbit_rs.figures.trajectory import desired_trajectory, obtained_trajectory
from onorbit_rs.figures.world_drawings import world_drawings
from onorbit_rs.figures.world_motion import formation_motion
from onorbit_rs.figures.world_subject import EventMark, WorldSubject, marks_of

__all__ = [
    "COLUMN",
    "PAGE",
    "Drawing",
    "EventMark",
    "Series",
    "Subject",
    "Tool",
    "WorldSubject",
    "as_bytes",
    "base_motion",
    "base_reaction",
    "captured_motion",
    "contact_energy",
    "contact_history",
    "contact_overview",
    "control_errors",
    "correlation_map",
    "desired_trajectory",
    "differences",
    "drawings",
    "energy_exchange",
    "environment_forces",
    "formation_motion",
    "ground_track",
    "joint_torques",
    "ledger",
    "loop_history",
    "manipulability",
    "marks_of",
    "momentum_exchange",
    "obtained_trajectory",
    "orbit_overview",
    "portrait",
    "relative_motion",
    "result_distributions",
    "save",
    "save_all",
    "strongest_pairs",
    "subject_of",
    "success_history",
    "tracking_errors",
    "with_fingers",
    "world_drawings",
]
