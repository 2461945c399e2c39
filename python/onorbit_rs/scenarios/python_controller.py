"""The controller of python_controller.yaml."""

import numpy as np

import onorbit_rs as oo


class Posture(oo.Controller):
    """Springs and dampers, nearly critical, pull the joints into a posture."""

    inertia = np.array([0.5, 0.4, 0.12, 0.12, 0.003, 0.001, 0.0004])  # that each joint feels, kg m²

    def __init__(self, posture, frequency):
        """Posture in rad, frequency of the springs in rad/s."""
        self.posture, self.frequency = np.array(posture), frequency

    def update(self, t, state):
        """Torques in N m, one per joint."""
        pull = self.frequency * (self.posture - state.q[7:]) - 2.0 * state.v[6:]
        return self.frequency * self.inertia * pull
