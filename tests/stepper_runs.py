"""Simulations that are advanced step by step, and the comparison of their traces."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import onorbit_rs as oo
from onorbit_rs.output.pickling import arrays_of
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build


def scenario(name: str = "humanoid_reach", **settings: Any) -> oo.Simulation:
    data = load(name).resolved()
    data["simulation"] |= {"duration": 2.0} | settings
    return build(load(data)).simulation


def passive(**settings: Any) -> oo.Simulation:
    """Returns a simulation of a robot without a controller."""
    model = oo.robots.load("humanoid_torso")
    return oo.Simulation(model, model.neutral(), np.full(model.nv, 0.01), **settings)


def assert_same_bits(a: oo.Trace, b: oo.Trace) -> None:
    first, second = arrays_of(a), arrays_of(b)
    assert first.keys() == second.keys()
    for name, values in first.items():
        np.testing.assert_array_equal(values, second[name], err_msg=name)


class Hold(oo.Controller):
    """Controller whose torque depends only on the time."""

    def __init__(self, torque: Callable[[float], Any]) -> None:
        self.torque, self.calls = torque, 0

    def update(self, t: float, state: Any) -> Any:
        self.calls += 1
        return self.torque(t)


def torque(t: float) -> Any:
    return 1e-3 * np.sin(t + np.arange(7))
