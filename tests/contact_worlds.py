"""Worlds of spheres that touch, for tests."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

import onorbit_rs as oo

HARD = oo.HuntCrossley(1e6, restitution=0.8, speed=0.2)


@cache
def ball() -> oo.Model:
    """Returns a sphere of 4 kg with a radius of 0.1 m."""
    return oo.robots.load("ball")


def moving(name: str, place: Any, velocity: Any, spin: Any = (0.0, 0.0, 0.0)) -> oo.System:
    """Returns a sphere with its position, m, velocity, m/s, and angular velocity, rad/s, in W."""
    return oo.System(name, ball(), [*place, 0.0, 0.0, 0.0, 1.0], [*velocity, *spin])


def pair(*, gap: float = 0.02, speed: float = 0.2, beside: float = 0.0, **contact: Any) -> oo.World:
    """Returns a world of two spheres, the first of which moves towards the second along x."""
    systems = [
        moving("a", [0.0, 0.0, 0.0], [speed, 0.0, 0.0]),
        moving("b", [np.sqrt(0.04 - beside**2) + gap, beside, 0.0], [0.0, 0.0, 0.0]),
    ]
    settings = {"normal": HARD, "name": "touch"} | contact
    return oo.World(systems, contacts=[oo.Contact("a/body", "b/*", **settings)])


def run(world: oo.World, duration: float = 0.2, **settings: Any) -> oo.WorldTrace:
    """Returns the trace of a world."""
    trace = oo.Simulation(world, **({"time_step": 2e-3} | settings)).run(duration)
    assert isinstance(trace, oo.WorldTrace)
    return trace
