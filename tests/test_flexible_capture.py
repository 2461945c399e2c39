"""Captures with locked joints and with springs: closed form of a boom, and the table of the bundled scenario.

``python tests/test_flexible_capture.py`` prints the table of ``docs/concepts/capture.md`` and draws the
picture of that page.
"""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.common.coordinates import ANGULAR, LINEAR
from onorbit_rs.figures.contact_energy import SUM, ledger_of
from onorbit_rs.figures.style import COLORS, COLUMN, LINE, SMALL, new_figure, tidy
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build_world import build_world

PAGE = Path(__file__).resolve().parents[1] / "docs" / "concepts" / "capture.md"
BASE, HAND, TARGET = 100.0, 5.0, 50.0
"""Masses of the base, of the hand at the end of its boom, and of the target, kg."""
CLOSING, STIFFNESS = 0.02, 800.0
"""Speed of the target towards the hand, m/s, and stiffness of the boom, N/m."""


def boom(*, is_locked: bool, stiffness: float = STIFFNESS) -> oo.WorldTrace:
    """Returns a capture at 0.5 s by a hand on a boom along x, which a brake locks or which has a spring."""
    builder = oo.ModelBuilder("chaser", base="base", mass=BASE, inertia=10.0 * np.eye(3))
    builder.add_link(
        "hand", parent="base", joint="boom", kind="prismatic", axis=[1, 0, 0], xyz=[1, 0, 0], mass=HAND,
        inertia=0.1 * np.eye(3), stiffness=0.0 if is_locked else stiffness,
    )  # fmt: skip
    model, target = builder.build(), oo.Model.rigid_body(TARGET, 5.0 * np.eye(3))
    place = np.array([1.0 + 0.5 * CLOSING, 0, 0, 0, 0, 0, 1.0])
    velocity = np.array([-CLOSING, 0, 0, 0, 0, 0])
    brakes = [oo.Brake("lock", "boom", engaged=True)] if is_locked else []
    systems = [
        oo.System("chaser", model, model.neutral(), np.zeros(7), actuators=brakes),
        oo.System("target", target, place, velocity),
    ]
    world = oo.World(systems, events=[oo.Capture("grasp", "chaser/hand", "target/base", at=0.5)])
    return oo.Simulation(world, time_step=1e-3).run(4.0)


def test_a_locked_boom_takes_the_impulse_of_both_craft() -> None:
    trace = boom(is_locked=True)
    (grasp,) = trace.events
    assert abs(np.linalg.norm(grasp.impulse[:3]) - CLOSING / (1 / TARGET + 1 / (BASE + HAND))) < 1e-13
    after = np.asarray(trace["chaser"].v)[np.asarray(trace["chaser"].time) > 0.5, 0]
    assert np.abs(after + CLOSING * TARGET / (BASE + HAND + TARGET)).max() < 1e-14


def test_a_spring_reduces_the_impulse_to_that_of_the_hand_and_transmits_the_rest() -> None:
    trace = boom(is_locked=False)
    (grasp,), chaser = trace.events, trace["chaser"]
    assert abs(np.linalg.norm(grasp.impulse[:3]) - CLOSING / (1 / TARGET + 1 / HAND)) < 1e-13
    mean, speed = CLOSING * TARGET / (BASE + HAND + TARGET), CLOSING * TARGET / (HAND + TARGET)
    reduced = BASE * (HAND + TARGET) / (BASE + HAND + TARGET)
    rate = math.sqrt(STIFFNESS / reduced)
    late = np.flatnonzero(np.asarray(chaser.time) == 0.5)[-1]
    time = np.asarray(chaser.time)[late:] - 0.5
    assert np.abs(chaser.v[late:, 0] + mean * (1.0 - np.cos(rate * time))).max() < 1e-11
    # the force of the spring is that on the base, at most v √(k μ)
    force = np.abs(BASE * chaser.acceleration[late:, 0]).max()
    assert abs(force / (speed * math.sqrt(STIFFNESS * reduced)) - 1.0) < 1e-6
    energy = trace.kinetic_energy + chaser.spring_energy
    assert np.ptp(energy[late:]) < 1e-10 * energy[0]
    assert abs(energy[late] + grasp.energy_lost - energy[0]) < 1e-14
    assert [line for line in trace.certificate() if not line[-1]] == []


def test_the_impulse_does_not_depend_on_the_stiffness_and_the_force_does() -> None:
    soft, stiff = boom(is_locked=False, stiffness=200.0), boom(is_locked=False, stiffness=3200.0)
    assert abs(soft.events[0].impulse[0] - stiff.events[0].impulse[0]) < 1e-13
    peaks = [float(np.abs(trace["chaser"].acceleration[:, 0]).max()) for trace in (soft, stiff)]
    assert peaks[1] / peaks[0] == pytest.approx(4.0, rel=1e-2)  # √(3200/200), between rows


@cache
def scenario_trace() -> Any:
    scenario: Any = load("flexible_capture")
    trace: Any = build_world(scenario).simulation.run(scenario.simulation.duration)
    assert [line for line in trace.certificate() if not line[-1]] == []
    return trace


def numbers() -> dict[str, tuple[float, float]]:
    """Returns the quantities of the table, with locked joints and with springs, in its units."""
    trace = scenario_trace()
    columns = [_of(trace, name) for name in ("rigid", "flexible")]
    return {key: (columns[0][key], columns[1][key]) for key in columns[0]}


def _of(trace: Any, name: str) -> dict[str, float]:
    robot = trace[name]
    event = next(event for event in trace.events if event.name == f"{name}_capture")
    first = np.flatnonzero(robot.time == event.time)[-1]
    v, a = np.asarray(robot.v)[first:], np.asarray(robot.acceleration)[first:]
    turning = np.linalg.norm(v[:, ANGULAR], axis=1)
    # the motion after the capture, without that of the last seconds in which an oscillation is not complete
    settled = np.asarray(robot.time)[first:] > 5.0
    return {
        "impulse of the capture, N s": float(np.linalg.norm(event.impulse[:3])),
        "energy lost in the capture, mJ": 1e3 * float(event.energy_lost),
        "energy dissipated in the joints until 15 s, mJ": 1e3 * float(robot.dissipated[-1]),
        "rate of the base just after the capture, mrad/s": 1e3 * float(turning[0]),
        "largest rate of the base, mrad/s": 1e3 * float(turning.max()),
        "mean rate of the base from 5 s, mrad/s": 1e3
        * float(np.linalg.norm(v[settled, ANGULAR].mean(axis=0))),
        "largest acceleration of the base after the capture, mm/s²": (
            1e3 * float(np.linalg.norm(a[:, LINEAR], axis=1).max())
        ),
        "largest energy of the springs, mJ": (
            0.0 if robot.spring_energy is None else 1e3 * float(np.max(robot.spring_energy))
        ),
    }


def table() -> str:
    """Returns the table of the page."""
    rows = [
        f"| {key} | {' | '.join(f'{value:.3g}' for value in values)} |" for key, values in numbers().items()
    ]
    return "\n".join(["| | joints locked | springs |", "|-|-|-|", *rows])


def test_the_springs_halve_the_impulse_and_the_mean_motion_is_the_same() -> None:
    found = numbers()
    rigid, flexible = found["impulse of the capture, N s"]
    assert flexible < 0.51 * rigid
    at_once = found["rate of the base just after the capture, mrad/s"]
    largest, mean = (
        found[f"{what}, mrad/s"] for what in ("largest rate of the base", "mean rate of the base from 5 s")
    )
    assert at_once[1] < 0.02 * at_once[0]
    assert largest[0] == pytest.approx(at_once[0], rel=1e-6) and largest[1] > 1.5 * largest[0]
    assert mean[1] == pytest.approx(mean[0], rel=0.02)
    # what the capture does not lose at once, the damping of the joints dissipates later
    lost, dissipated = (
        found["energy lost in the capture, mJ"], found["energy dissipated in the joints until 15 s, mJ"]
    )  # fmt: skip
    assert dissipated[0] == 0.0
    assert 0.95 * lost[0] < lost[1] + dissipated[1] < lost[0]


def test_the_ledger_of_the_group_contains_the_springs() -> None:
    trace = boom(is_locked=False)
    _, lines = ledger_of(trace, trace.names, trace.events)
    (balance,) = (values for name, values in lines.items() if name.startswith(SUM))
    assert lines["elastic"].max() > 0.1 * balance[0]
    assert np.ptp(balance) < 1e-10 * balance[0]


def test_the_page_has_the_measured_numbers() -> None:
    assert table() in PAGE.read_text(encoding="utf-8"), (
        "update the page: python tests/test_flexible_capture.py"
    )


def picture(file: Path) -> None:
    """Draws the rates of both bases and the energy of the springs in the first seconds."""
    figure = new_figure(COLUMN, 3.0)
    above, below = figure.subplots(2, 1, sharex=True)
    for color, name in zip(COLORS, ("rigid", "flexible"), strict=False):
        robot = scenario_trace()[name]
        rows = np.asarray(robot.time) < 6.0
        rates = 1e3 * np.linalg.norm(np.asarray(robot.v)[rows][:, ANGULAR], axis=1)
        label = {"rigid": "joints locked", "flexible": "springs"}[name]
        above.plot(np.asarray(robot.time)[rows], rates, color=color, linewidth=LINE, label=label)
        if robot.spring_energy is not None:
            stored = 1e3 * np.asarray(robot.spring_energy)[rows]
            below.plot(np.asarray(robot.time)[rows], stored, color=color, linewidth=LINE)
    tidy(above, "", "base rate [mrad/s]")
    tidy(below, "time [s]", "in springs [mJ]")
    above.legend(fontsize=SMALL, frameon=False)
    figure.savefig(file)


if __name__ == "__main__":
    print(table())
    picture(PAGE.parents[1] / "images" / "flexible_capture.png")
