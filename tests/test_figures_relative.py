"""Figure of the path relative to the reference orbit: Hill's ellipse and targets."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs import figures
from onorbit_rs.figures.relative import paths_in_orbit
from onorbit_rs.scenario import load
from onorbit_rs.scenario.targets import Target

RADIUS = 7e6
RATE = np.sqrt(398600.4418e9 / RADIUS**3)


def hill(start: float = 50.0, along: float = 0.0) -> oo.Run:
    """Runs one revolution of a closed ellipse of width ``4 start``: `ẏ = -2 n x`."""
    data: dict[str, Any] = {
        "robot": {"rigid_body": {"mass": 100.0, "inertia": [10.0, 12.0, 8.0]}},
        "orbit": {"kind": "kepler", "semi_major_axis": RADIUS, "inclination": 1.7},
        "initial": {"frame": "lvlh", "position": [start, along, 0.4 * start],
                    "linear_velocity": [0.0, -2.0 * RATE * start, 0.0]},
        "simulation": {"duration": 2.0 * np.pi / RATE, "time_step": 10.0},
    }  # fmt: skip
    return oo.run(data, quiet=True)


def subject(run: oo.Run) -> figures.Subject:
    orbit = None if run.scenario.orbit is None else run.scenario.orbit.build(Path())
    return figures.subject_of(run.trace, run.scenario, run.model, orbit, None)


def names(subject: figures.Subject) -> list[str]:
    return [drawing.name for drawing in figures.drawings(subject)]


def test_a_free_base_draws_hills_ellipse() -> None:
    """It is x = x0 cos nt, y = -2 x0 sin nt, z = z0 cos nt (Clohessy and Wiltshire, 1960)."""
    run = hill()
    assert "relative_motion" in names(subject(run))
    plane, across = figures.relative_motion(run.trace).axes
    angle = RATE * np.asarray(run.trace.time)
    expected = np.column_stack([50.0 * np.cos(angle), -100.0 * np.sin(angle), 20.0 * np.cos(angle)])
    for axes, rows in ((plane, [1, 0]), (across, [1, 2])):
        drawn = np.column_stack([np.asarray(axes.lines[0].get_data())]).T
        # second-order terms, 3 x² / r = 1e-3 m, growing with the angle
        np.testing.assert_allclose(drawn, expected[:, rows], atol=0.02)
        assert np.abs(drawn - expected[:, rows[::-1]]).max() > 10.0
        assert (axes.get_aspect(), axes.get_xlabel()) == (1.0, "along track [m]")
    assert np.ptp(plane.get_xlim()) == pytest.approx(np.ptp(across.get_xlim()))  # one scale


def test_a_robot_that_stays_near_its_reference_has_no_such_figure() -> None:
    assert "relative_motion" not in names(subject(hill(0.05)))
    reach = load("humanoid_reach").resolved()
    reach["simulation"] |= {"duration": 0.2, "time_step": 1e-2}
    assert "relative_motion" not in names(subject(oo.run(reach, quiet=True)))  # no orbit


def test_a_distant_reference_is_not_drawn() -> None:
    def labels(run: oo.Run) -> list[str]:
        (legend,) = figures.relative_motion(run.trace).legends
        return [text.get_text() for text in legend.get_texts()]

    assert labels(hill()) == ["base", "start", "end", "reference"]
    assert labels(hill(20.0, along=3000.0)) == ["base", "start", "end"]


def test_targets_are_drawn_relative_to_the_reference() -> None:
    run = hill()
    beside = Target(
        position=np.array([10.0, 0.0, 0.0]), quat_xyzw=np.array([0.0, 0.0, 0.0, 1.0]),
        velocity=np.array([0.0, 0.02, 0.0]), spin=np.zeros(3),
    )  # fmt: skip
    _, path = paths_in_orbit(run.trace, [beside])
    lengths = np.linalg.norm(beside.position + np.outer(run.trace.time, beside.velocity), axis=1)
    np.testing.assert_allclose(np.linalg.norm(path, axis=1), lengths, rtol=1e-12)  # only the rotation of L
    figure = figures.relative_motion(run.trace, [beside, beside])
    drawn = [line.get_label() for line in figure.axes[0].lines]
    assert drawn.count("target") == 1 and len(drawn) == 10
    np.testing.assert_allclose(figure.axes[0].lines[3].get_xdata(), path[:, 1], rtol=1e-12)


def test_targets_come_from_the_scenario() -> None:
    approach = load("approach_target")
    (target,) = subject(moment_of(approach)).targets
    frame: Any = approach.reference
    assert target.velocity.tolist() == frame.frame.target.velocity


def moment_of(scenario: Any) -> oo.Run:
    """Runs the first 0.05 s of a scenario."""
    data = scenario.resolved()
    data["simulation"] |= {"duration": 0.05, "time_step": 5e-3}
    return oo.run(data, quiet=True)
