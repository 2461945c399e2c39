"""Controller of the scenario python_controller.yaml."""

import numpy as np

import onorbit_rs as oo


class Posture(oo.Controller):
    """Moves the joints to a posture with springs and nearly critical dampers."""

    inertia = np.array([0.5, 0.4, 0.12, 0.12, 0.003, 0.001, 0.0004])  # moved by each joint, kg m²

    def __init__(self, posture, frequency):
        """Store the posture, rad, and the natural frequency of the springs, rad/s."""
        self.posture, self.frequency = np.array(posture), frequency

    def update(self, t, state):
        """Return the joint torques, (n,), N m."""
        pull = self.frequency * (self.posture - state.q[7:]) - 2.0 * state.v[6:]
        return self.frequency * self.inertia * pull
