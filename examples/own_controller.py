"""A custom controller that moves the arm of a free-floating robot to a posture.

Run: python examples/own_controller.py
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import onorbit_rs as oo


class Posture(oo.Controller):
    """Computed torque in joint space; the reduced model accounts for the recoil of the base."""

    def __init__(self, model: oo.Model, goal: NDArray[np.float64], *, frequency: float) -> None:
        self.model, self.goal, self.frequency = model, goal, frequency

    def update(self, t: float, state: oo.State) -> NDArray[np.float64]:
        ff = self.model.free_floating(state.q, state.v, "tool")
        acceleration = self.frequency**2 * (self.goal - state.q[7:]) - 2 * self.frequency * state.v[6:]
        return ff.inertia @ acceleration + ff.bias  # M* q̈ + c*


def main() -> None:
    model = oo.robots.load("humanoid_torso")
    goal = np.array([0.6, -1.8, -1.5, -1.9, -1.2, 0.3, 0.2])
    q, v = model.neutral(), np.zeros(model.nv)
    q[7:] = [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]
    simulation = oo.Simulation(
        model, q, v,
        orbit=oo.Kepler(semi_major_axis=6778e3, inclination=0.9),
        environment=[oo.GravityGradient()],
        controller=Posture(model, goal, frequency=3.0),
        time_step=2e-3,
    )  # fmt: skip
    trace = simulation.run(6.0)
    off = abs(trace.q[-1, 7:] - goal).max()
    turn = 2 * np.arccos(min(1.0, abs(trace.q[-1, 6])))
    print(f"final joint error {off:.1e} rad, largest torque {abs(trace.tau).max():.2f} N m")
    print(f"final rotation of the base: {np.degrees(turn):.1f} degrees")
    for name, value, gate, passed in trace.certificate():
        print(f"  {name:28} {'passed' if passed else 'BROKEN'}: {value:.1e}, gate {gate:.1e}")
    assert off < 1e-5


if __name__ == "__main__":
    main()
