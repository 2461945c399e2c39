"""Tests that a capsule held between two pads by friction creeps under neither constant nor varying loads."""

from __future__ import annotations

import numpy as np

import onorbit_rs as oo
from onorbit_rs.tools.validation.case import Case, Gate
from onorbit_rs.tools.validation.contact_bodies import IMMOVABLE, at, body, oscillating, turning

MASS, RADIUS, LENGTH = 0.045, 4e-3, 0.03  # of the capsule, kg and m
MU = 0.7
STIFFNESS = 1e5  # N/m
CAPSULE = f'<capsule radius="{RADIUS}" length="{LENGTH}"/>'
PAD = '<box size="0.02 0.06 0.06"/>'
LOAD, SWING, PERIOD = 0.44, 0.2, 0.1  # N, N, s
ROWS = 10  # one row per period
LARGE_SWING = 8.0  # N; both pads hold 2 mu 12 N = 16.8 N


def held(normal: float, load: float, swing: float, lasts: float) -> float:
    """Return the drift of the capsule along its axis during the second half of a run, in m/s.

    Parameters
    ----------
    normal : float
        Normal force of each pad, N.
    load, swing : float
        Constant load along the axis and amplitude of an oscillating one with a period of 0.1 s, N.
    lasts : float
        Duration, s: an even number of periods.
    """
    depth = normal / STIFFNESS
    rate = 2.0 * np.pi / PERIOD
    capsule = body(CAPSULE, MASS, [4e-6, 4e-6, 4e-7], rotors="1 0 0")
    pads = [
        at(name, body(PAD, IMMOVABLE, IMMOVABLE), [side * (RADIUS + 0.01 - depth), 0.0, 0.0])
        for name, side in (("left", -1.0), ("right", 1.0))
    ]
    contacts = [
        oo.Contact(
            f"{pad}/body", "capsule/body", name=pad, start_overlapping=True,
            normal=oo.HuntCrossley(STIFFNESS, 1.0, dissipation=1.0),
            friction=oo.Friction(MU, stiffness=STIFFNESS),
        )
        for pad in ("left", "right")
    ]  # fmt: skip
    constant = oo.BodyWrench("capsule/body", force=[0.0, 0.0, -load])
    loads = [constant, *oscillating("capsule", swing, (0.0, 0.0, 1.0))] if swing else [constant]
    world = oo.World(
        [turning("capsule", capsule, np.zeros(3), rate), *pads], contacts=contacts, environment=loads
    )
    trace = oo.Simulation(world, time_step=PERIOD / 10, record_every=ROWS).run(lasts)
    assert isinstance(trace, oo.WorldTrace)
    capsule_trace = trace["capsule"]
    half = int(np.argmin(np.abs(capsule_trace.time - lasts / 2)))
    moved = capsule_trace.q[[half, -1], 2]
    if not abs(moved[0]) < 1e-3:
        slipped = f"the capsule slipped by {abs(moved[0]):.3g} m in the first half of the run"
        raise ValueError(f"{slipped}; the limit is 1e-3 m")
    return float(abs(moved[1] - moved[0]) / (lasts / 2))


def steady() -> list[float]:
    """Return the drift for both normal forces, m/s."""
    return [held(normal, LOAD, 0.0, 1.0) for normal in (12.0, 60.0)]


def shaken() -> list[float]:
    """Return the drift, m/s, under small oscillating loads, and under loads of half the largest friction."""
    return [held(12.0, LOAD, SWING, 2.0), held(12.0, LOAD, LARGE_SWING, 2.0)]


CASES = (
    Case(
        "contact", "a capsule held by two pads", "Coulomb: rest inside the friction cone",
        (
            Gate("drift, pads press with 12 N", 1e-9, "m/s"),
            Gate("drift, pads press with 60 N", 1e-9, "m/s"),
        ), steady,
    ),
    Case(
        "contact", "a held capsule under oscillating loads", "Coulomb: rest inside the friction cone",
        (
            Gate("drift, load oscillates by 0.2 N at 10 Hz", 1e-9, "m/s"),
            Gate("drift, load oscillates by 8 N at 10 Hz", 1e-9, "m/s"),
        ), shaken,
    ),
)  # fmt: skip
