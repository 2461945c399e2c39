"""Wrong methods and constants for closed loops, as controls of validation."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.common.coordinates import BASE_NV, JOINTS_V
from onorbit_rs.tools.validation import (
    against_pinocchio_loops,
    gauss,
    linkages,
    loops,
    loops_drift,
    loops_gauss,
)  # fmt: skip

LASTS = 1.0  # s; the error after the whole run would be larger
RATE = 20.0  # rad/s, of Baumgarte's stabilisation


def _simulate(
    acceleration: Callable[..., Any], model: oo.Model, q: Any, v: Any, step: float
) -> SimpleNamespace:
    """Returns configurations, velocities and energies of a run by the Runge-Kutta method."""
    rows = [(q, v)]
    for _ in range(round(LASTS / step)):
        q, v = rows[-1]
        rates, slopes = [v], [acceleration(model, q, v)]
        for part in (0.5, 0.5, 1.0):
            stage = model.integrate(q, part * step * rates[-1])
            rates.append(v + part * step * slopes[-1])
            slopes.append(acceleration(model, stage, rates[-1]))
        weights = np.array([1, 2, 2, 1]) / 6.0
        rows.append((model.integrate(q, step * (weights @ rates)), v + step * (weights @ slopes)))
    qs, vs = (np.array(column) for column in zip(*rows, strict=True))
    energy = [0.5 * v @ model.mass_matrix(q) @ v for q, v in rows]
    return SimpleNamespace(
        q=qs, v=vs, time=step * np.arange(len(qs)), kinetic_energy=np.array(energy)
    )  # fmt: skip


def baumgarte(model: oo.Model, q: Any, v: Any, duration: float, step: float = 1e-3) -> Any:
    """Simulates with `φ̈ + 2 α φ̇ + α² φ = 0` in place of a projection."""

    def acceleration(model: oo.Model, q: Any, v: Any) -> Any:
        rows, mass = loops_gauss.rows(model, q), np.array(model.mass_matrix(q))
        wanted = 2.0 * RATE * rows @ v + RATE**2 * np.asarray(model.loop_errors(q))
        response = np.linalg.solve(mass, rows.T)
        closed, _ = model.constrained_forward_dynamics(q, v, np.zeros(model.nv))
        return closed - response @ np.linalg.pinv(rows @ response, rcond=1e-10) @ wanted

    return _simulate(acceleration, model, q, v, step)


def close_by_joints(model: oo.Model, q: Any, v: Any) -> tuple[Any, Any]:
    """Closes the loops by the joints alone, which moves the centre of mass and changes the momentum."""
    for _ in range(20):
        inverse = np.linalg.pinv(loops_gauss.rows(model, q)[:, JOINTS_V], rcond=1e-8)
        q = model.integrate(q, np.r_[np.zeros(BASE_NV), -inverse @ model.loop_errors(q)])
    rows = loops_gauss.rows(model, q)
    inverse = np.linalg.pinv(rows[:, JOINTS_V], rcond=1e-8)
    return q, v - np.r_[np.zeros(BASE_NV), inverse @ (rows @ v)]


def loops_after_the_impulse(first: gauss.Craft, second: gauss.Craft) -> Any:
    """Returns the velocities after a capture whose impulse ignores the loops, which are then projected."""
    crafts = (first, second)
    mass, before = gauss.mass_matrix(crafts), np.concatenate([first.v, second.v])
    after = loops_gauss.nearest(mass, gauss.relative_twist(crafts, 0, 1), before)
    rows = loops_gauss.rows(first.model, first.q)
    own = np.hstack([rows, np.zeros((len(rows), second.model.nv))])
    return loops_gauss.nearest(mass, own, after)


def without_loops(first: gauss.Craft, second: gauss.Craft) -> Any:
    """Returns the velocities after a capture by a robot without loops."""
    crafts = (first, second)
    before = np.concatenate([first.v, second.v])
    return loops_gauss.nearest(gauss.mass_matrix(crafts), gauss.relative_twist(crafts, 0, 1), before)


def without_second_loop(model: oo.Model, q: Any, rows: Any = loops_gauss.rows) -> Any:
    first, second = (loop.rows for loop in model.loops[:2])
    return np.delete(rows(model, q), np.arange(first, first + second), axis=0)


def with_second_loop_open(
    text: str, model: oo.Model, loops: Any, *state: Any, solve: Any = against_pinocchio_loops.theirs
) -> Any:
    return solve(text, model, [loops[0], *loops[2:]], *state)


def of_longer_coupler(crank: float, lengths: Any, solve: Any = linkages.four_bar) -> Any:
    return solve(crank, [lengths[0], lengths[1] + 1e-9, *lengths[2:]])


def of_longer_rod(crank: float, a: float, b: float, solve: Any = linkages.slider_crank) -> Any:
    return solve(crank, a, b + 1e-9)


def spinning_faster(model: oo.Model, q: Any, v: Any, duration: float, run: Any = loops.simulate) -> Any:
    return run(model, q, v * (1.0 + 1e-9), duration)


def with_heavier_load(masses: Any, build: Any = loops.two_fingers) -> Any:
    return build((*masses[:2], masses[2] + 1e-6))


def with_other_ratio(ratio: float, inertias: Any, build: Any = loops.geared_wheels) -> Any:
    return build(ratio + 1e-9, inertias)


def with_slip(_: float, duration: float, run: Any = loops.braked) -> Any:
    return run(1.0, duration)


CONTROLS: list[tuple[str, str, Any, str, Any]] = [
    ("loops", "a four-bar linkage, 5 s, closed by a pin or a ball joint", loops, "simulate",
     baumgarte),
    ("loops", "two cranks with a massless rod, 5 s", linkages, "four_bar", of_longer_coupler),
    ("loops", "a slider-crank, 5 s, closed at its pin or at its slide", linkages, "slider_crank",
     of_longer_rod),
    ("loops", "a rod holds two sliders on a spinning craft", loops, "simulate", spinning_faster),
    ("loops", "two fingers squeeze a load, at rest and moving", loops, "two_fingers", with_heavier_load),
    ("loops", "a mimic joint with the ratio -2.5", loops, "geared_wheels", with_other_ratio),
    ("loops", "a rigid brake on the crank of a four-bar linkage", loops, "braked", with_slip),
    ("loops", "a slipping brake on the crank of a four-bar linkage", loops, "BRAKE", 0.0500001),
    ("loops", "12 random trees with redundant loops", loops_gauss, "rows", without_second_loop),
    ("loops", "12 captures by a gripper of four-bar linkages with a mimic joint", loops_gauss,
     "expected_capture", loops_after_the_impulse),
    ("loops", "12 captures by a gripper of four-bar linkages with a mimic joint", loops_gauss,
     "expected_capture", without_loops),
    ("loops", "12 grippers whose open loops are closed", loops_gauss, "close",
     close_by_joints),
    ("loops", "two arms hold a load, 100 s at 1 ms", loops_drift, "simulate", baumgarte),
    ("loops", "a tumbling four-bar linkage, step halved twice", loops_drift, "INTEGRATOR",
     "semi_implicit_euler"),
    ("loops", "8 random trees with two or three loops, some redundant", against_pinocchio_loops, "theirs",
     with_second_loop_open),
]  # fmt: skip
"""Family and name of a case, and the module, the name and the value of what is replaced."""
