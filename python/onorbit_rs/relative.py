"""Relative motion of satellites.

>>> import numpy as np
>>> from onorbit_rs import relative
>>> n = 2 * np.pi / 5400  # rad/s
>>> start = [0.0, 100.0, 0.0, 0.0, 0.0, 0.0]  # 100 m ahead on the same circle: it does not move
>>> np.allclose(relative.hill_transition(n, 1000.0) @ start, start)
True
"""

from onorbit_rs._core import (
    deputy_state,
    from_lvlh,
    hill_transition,
    intercept_velocity,
    relative_elements,
    to_lvlh,
    to_world,
)

__all__ = [
    "deputy_state",
    "from_lvlh",
    "hill_transition",
    "intercept_velocity",
    "relative_elements",
    "to_lvlh",
    "to_world",
]
