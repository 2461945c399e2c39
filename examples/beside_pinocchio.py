"""Compares the forward dynamics of a URDF in onorbit_rs and in Pinocchio: results and computation times.

Requires: pip install pin

Run: python examples/beside_pinocchio.py [ROBOT.urdf]
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np
import pinocchio as pin

import onorbit_rs as oo


def microseconds(call: Callable[[], object], repeats: int = 2000) -> float:
    """Returns the time of one call in microseconds: the best of five rounds."""
    rounds = []
    for _ in range(5):
        began = time.perf_counter()
        for _ in range(repeats // 5):
            call()
        rounds.append((time.perf_counter() - began) / (repeats // 5))
    return 1e6 * min(rounds)


def main(urdf: str = str(oo.robots.path("humanoid_torso"))) -> None:
    model = oo.Model.from_urdf(urdf)
    pin_model = pin.buildModelFromUrdf(urdf, pin.JointModelFreeFlyer())
    pin_model.gravity.setZero()  # onorbit_rs computes the dynamics in free fall
    data = pin_model.createData()

    rng = np.random.default_rng(1)
    q = model.integrate(model.neutral(), rng.uniform(-1, 1, model.nv))
    v = rng.uniform(-1, 1, model.nv)
    q_pin, v_pin = oo.layouts.to_pinocchio(model, q, v, pin_model)  # in Pinocchio's order of joints
    tau_pin = np.zeros(pin_model.nv)
    tau = np.zeros(model.nv)

    a = model.forward_dynamics(q, v, tau)
    a_pin = pin.aba(pin_model, data, q_pin, v_pin, tau_pin)
    _, a = oo.layouts.to_pinocchio(model, q, a, pin_model)  # in Pinocchio's order and layout
    print(f"largest difference of accelerations, relative: {abs(a - a_pin).max() / abs(a_pin).max():.1e}")

    here = microseconds(lambda: model.forward_dynamics(q, v, tau))
    there = microseconds(lambda: pin.aba(pin_model, data, q_pin, v_pin, tau_pin))
    print(f"one state, from Python: {here:.1f} µs (onorbit_rs), {there:.1f} µs (Pinocchio)")
    many_q, many_v, many_tau = (np.tile(x, (4096, 1)) for x in (q, v, tau))
    out = np.empty_like(many_v)
    batch = microseconds(lambda: model.forward_dynamics(many_q, many_v, many_tau, out=out), 50) / len(many_q)
    print(f"one state in a batch of {len(many_q)}: {batch:.2f} µs")


if __name__ == "__main__":
    main(*sys.argv[1:])
