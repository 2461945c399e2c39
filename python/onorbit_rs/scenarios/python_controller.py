"""The controller of python_controller.yaml."""

import numpy as np

import onorbit_rs as oo


class Posture(oo.Controller):
    """Springs and dampers, critical for what each joint carries, pull the joints into a posture."""

    inertia = np.array([1.2, 1.2, 0.4, 0.4, 0.05, 0.05, 0.02])  # about each joint, kg m², roughly

    def __init__(self, posture, frequency):
        """Posture in rad, frequency of the springs in rad/s."""
        self.posture, self.frequency = np.array(posture), frequency

    def update(self, t, state):
        """Torques in N m, one per joint."""
        pull = self.frequency * (self.posture - state.q[7:]) - 2.0 * state.v[6:]
        return self.frequency * self.inertia * pull
