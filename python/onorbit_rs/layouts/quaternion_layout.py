"""Layouts in which the attitude of the base is a quaternion and every joint has one coordinate."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from onorbit_rs.common.coordinates import ANGULAR, BASE_NQ, BASE_NV, JOINTS_V, LINEAR, POSITION, QUATERNION
from onorbit_rs.layouts.state import check_unit, concatenated, in_model_order, to_body, to_world

if TYPE_CHECKING:
    from typing import Any

    from numpy.typing import NDArray

    from onorbit_rs.layouts.state import Floats


class QuaternionLayout(NamedTuple):
    """Order of the coordinates in another engine; the linear velocity of the base is in world axes.

    Attributes
    ----------
    position, joints : slice
        Entries of the base position and of the joint positions in the configuration.
    quaternion : list of int
        Indices of x, y, z and w of the base quaternion in the configuration.
    linear, angular : slice
        Entries of the linear and the angular velocity of the base in the velocity; the joint rates follow.
    is_angular_in_world : bool
        True if the angular velocity is in world axes, False if it is in base axes.
    """

    position: slice
    quaternion: list[int]
    joints: slice
    linear: slice = slice(0, 3)
    angular: slice = slice(3, 6)
    is_angular_in_world: bool = False

    def from_model(self, state: tuple[Floats, Floats], order: NDArray[Any]) -> tuple[Floats, Floats]:
        """Return the configuration and the velocity of the other engine from those of onorbit_rs."""
        q_model, v_model = state
        q_other, v_other = np.empty(q_model.shape), np.empty(v_model.shape)
        quat, angular = q_model[..., QUATERNION], v_model[..., ANGULAR]
        q_other[..., self.position] = q_model[..., POSITION]
        q_other[..., self.quaternion] = quat
        q_other[..., self.joints] = q_model[..., BASE_NQ + order]
        v_other[..., self.linear] = to_world(quat, v_model[..., LINEAR])
        v_other[..., self.angular] = to_world(quat, angular) if self.is_angular_in_world else angular
        v_other[..., JOINTS_V] = v_model[..., BASE_NV + order]
        return q_other, v_other

    def to_model(self, name: str, state: list[Floats], order: NDArray[Any]) -> tuple[Floats, Floats]:
        """Return `q` and `v` of onorbit_rs; ``name`` is the name of the given configuration in messages."""
        q_other, v_other = state
        quat, angular = q_other[..., self.quaternion], v_other[..., self.angular]
        check_unit(name, quat)
        linear = to_body(quat, v_other[..., self.linear])
        angular = to_body(quat, angular) if self.is_angular_in_world else angular
        return (
            concatenated(q_other[..., self.position], quat, in_model_order(q_other[..., self.joints], order)),
            concatenated(linear, angular, in_model_order(v_other[..., JOINTS_V], order)),
        )
