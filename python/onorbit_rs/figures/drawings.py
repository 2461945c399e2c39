"""Figures that apply to a run, with their names and captions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from onorbit_rs.common.file_parts import file_part, numbered_part
from onorbit_rs.common.rotations import has_local_frame
from onorbit_rs.figures.forces import environment_forces
from onorbit_rs.figures.grip import grip_force
from onorbit_rs.figures.ground_track import ground_track
from onorbit_rs.figures.ledger import ledger
from onorbit_rs.figures.loop_history import loop_history
from onorbit_rs.figures.manipulability import manipulability
from onorbit_rs.figures.motion import base_motion, base_reaction
from onorbit_rs.figures.orbit import orbit_overview
from onorbit_rs.figures.relative import goes_far, relative_motion
from onorbit_rs.figures.tracking import control_errors, joint_torques, tracking_errors
from onorbit_rs.figures.trajectory import desired_trajectory, obtained_trajectory
from onorbit_rs.visuals.earth_shape import is_earth

if TYPE_CHECKING:
    from onorbit_rs._core import Trace
    from onorbit_rs.figures.subject import Subject

WORTH_AN_ORBIT_DEG = 5.0
"""Smallest angle around the planet, degrees, for which the orbit is drawn."""


@dataclass(frozen=True)
class Drawing:
    """A figure to be drawn; ``name`` is the stem of its file."""

    name: str
    caption: str
    draw: Callable[[], Figure]


def drawings(subject: Subject) -> Iterator[Drawing]:
    """Yield every figure that applies to a run; in the experiment of OnOrbitROS, numbered as in the paper."""
    for number, drawing in _all(subject):
        if number and subject.is_the_papers:
            named = f"fig{number}_{drawing.name}"
            yield Drawing(named, f"Fig. {number} of the OnOrbitROS paper. {drawing.caption}", drawing.draw)
        else:
            yield drawing


def _all(subject: Subject) -> Iterator[tuple[int, Drawing]]:
    """Yield each drawing with the number of the corresponding figure in the paper, or 0."""
    yield from _of_the_arm(subject)
    for drawing in _of_the_base(subject):
        yield 0, drawing


def _of_the_arm(subject: Subject) -> Iterator[tuple[int, Drawing]]:
    trace, model = subject.trace, subject.model
    if "reference_pose" in trace.columns():
        if model is not None:
            about = "Path of the tool in W, desired (black) and obtained (orange); the robot at three times."
            yield 4, Drawing("desired_trajectory", about, partial(desired_trajectory, trace, model))
        about = "Path of the tool in W, desired (black) and obtained (orange)."
        yield 5, Drawing("obtained_trajectory", about, partial(obtained_trajectory, trace))
    if "position_error" in trace.columns() and len(subject.tools) < 2:
        about = (
            "Desired minus obtained pose of the tool in axes of W; the attitude error is a rotation vector."
        )
        yield 6, Drawing("tracking_errors", about, partial(tracking_errors, trace))
    if model is not None and model.joint_names and np.any(trace.tau):
        about = "Effort of every joint, held over each control step."
        yield 7, Drawing("joint_torques", about, partial(joint_torques, trace, model))
    for drawing in _of_the_controls(subject):
        yield 0, drawing


def _of_the_controls(subject: Subject) -> Iterator[Drawing]:
    trace, model = subject.trace, subject.model
    for tool in subject.tools:
        if tool.control in trace.tracking and len(subject.tools) > 1:
            about = (
                f"Tracking errors of the controller {tool.control}, which moves {tool.frame}, in axes of W."
            )
            name = f"tracking_errors_{file_part(tool.control)}"
            yield Drawing(name, about, partial(control_errors, trace, tool.control, []))
    for control, joints in (subject.joint_controls or {}).items():
        if control in trace.tracking and joints and np.any(trace.tracking[control]):
            is_alone = not subject.tools and len(subject.joint_controls or {}) == 1
            whose = "." if is_alone else f" of the controller {control}."
            are_rates = control in subject.rate_controls
            what = "rates" if are_rates else "positions"
            about = f"Desired minus obtained {what} of the joints{whose}"
            name = "joint_errors" if is_alone else f"joint_errors_{file_part(control)}"
            drawing = partial(control_errors, trace, control, joints, model, are_rates=are_rates)
            yield Drawing(name, about, drawing)
    for control, grip in (subject.grips or {}).items():
        if control in trace.tracking and np.any(trace.tracking[control]):
            about = (
                f"Commanded and actual mean normal force of the fingers that the controller {control} closes."
            )
            drawing = partial(grip_force, trace, control, grip)
            yield Drawing(f"grip_force_{file_part(control)}", about, drawing)
    if model is None:
        return
    for tool in subject.tools:
        if len(tool.joints) >= 3:
            about = (
                f"Manipulability of {tool.frame} along its path, √det(J Jᵀ), with the base free (generalized "
                "Jacobian) and with the base fixed; at zero the tool cannot move in some direction."
            )
            name = "manipulability" + (f"_{file_part(tool.control)}" if len(subject.tools) > 1 else "")
            yield Drawing(name, about, partial(manipulability, trace, model, tool.frame, tool.joints))


def _of_the_base(subject: Subject) -> Iterator[Drawing]:
    trace, model = subject.trace, subject.model
    yield Drawing("base_motion", "Position and attitude of the base in W.", partial(base_motion, trace))
    about = "Reaction of the base: angle of rotation since the start, and angular velocity in base axes."
    yield Drawing("base_reaction", about, partial(base_reaction, trace))
    about = (
        "Momentum and energy in W, and the part of their change that impulse and work do not explain; "
        "angular momentum is about the centre of mass."
    )
    yield Drawing("ledger", about, partial(ledger, trace))
    yield from _of_the_loops(trace)
    if trace.wrenches and model is not None:
        about = "Force and torque of every effect on every body; torques are about the body's centre of mass."
        if subject.is_carried:
            about += (
                " The robot moves with its reference, whose motion includes these effects: the common "
                "acceleration due to drag and light is removed, and only the tidal part of gravity remains."
            )
        yield Drawing("environment_forces", about, partial(environment_forces, trace, model.body_names))
    if model is not None and has_local_frame(trace) and goes_far(trace, model):
        about = "Paths relative to the reference orbit in L: seen along the orbit normal, and from above."
        yield Drawing("relative_motion", about, partial(relative_motion, trace, subject.targets))
    if subject.mu is None or not has_local_frame(trace) or _angle_flown_deg(trace) <= WORTH_AN_ORBIT_DEG:
        return
    about_earth = is_earth(subject.mu)
    about = "The orbit to scale in inertial axes, its radius, and the attitude of the base relative to L."
    yield Drawing("orbit", about, partial(orbit_overview, trace, is_earth=about_earth))
    earth = subject.earth
    if about_earth and earth is not None:
        about = "Ground track in geodetic coordinates, and height above the ellipsoid."
        yield Drawing("ground_track", about, partial(ground_track, trace, earth))


def _of_the_loops(trace: Trace) -> Iterator[Drawing]:
    """Yield a figure for each loop that was closed at some time."""
    for number, (loop, rows) in enumerate(trace.loops.items()):
        if not np.any(rows.values):
            continue
        about = (
            f"Loop {loop}: force on its second frame and moment about its point, in W, and the distance and "
            "the angle by which it is open. Rounding errors are about 1e-16 m or rad."
        )
        yield Drawing(f"loop_{numbered_part(number, loop)}", about, partial(loop_history, trace, loop))


def _angle_flown_deg(trace: Trace) -> float:
    """Return the largest angle, degrees, between the first and a later position from the planet's centre."""
    direction = np.asarray(trace.position_eci)
    direction = direction / np.linalg.norm(direction, axis=1, keepdims=True)
    return float(np.degrees(np.arccos(np.clip(direction @ direction[0], -1.0, 1.0)).max()))
