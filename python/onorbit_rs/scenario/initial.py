"""Initial state of the run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, NamedTuple

import numpy as np
from pydantic import BeforeValidator, Field
from pydantic_core import PydanticKnownError

from onorbit_rs.common.coordinates import ANGULAR, JOINTS_Q, JOINTS_V, LINEAR, POSITION, QUATERNION
from onorbit_rs.common.rotations import matrix_from_quaternion, quaternion_from_matrix
from onorbit_rs.scenario.attitude import Attitude, quaternion_of
from onorbit_rs.scenario.fields import AngularRate3, Length3, Speed3
from onorbit_rs.scenario.joint_values import JointPositions, JointRates, joint_values
from onorbit_rs.scenario.part import Part

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model, Orbit

    Floats = NDArray[np.float64]


_FRAMES = ("world", "lvlh", "path")


def _frame(value: Any) -> Any:
    if value in _FRAMES or (isinstance(value, str) and all(value.partition("/"))):
        return value
    raise PydanticKnownError("literal_error", {"expected": "'world', 'lvlh', 'path' or SYSTEM/FRAME"})


InitialFrame = Annotated[str, BeforeValidator(_frame)]


class Neighbour(NamedTuple):
    """Model, configuration and velocity of another system in its initial state."""

    model: Model
    q: Floats
    v: Floats


class InitialState(Part):
    """Pose and twist of the base, positions and rates of the joints; each is zero by default."""

    synonyms: ClassVar = {
        "velocity": "linear_velocity", "spin": "angular_velocity", "orientation": "attitude",
        "q": "joints", "joint_velocities": "joint_rates",
    }  # fmt: skip

    frame: InitialFrame = "world"
    """Frame in which ``position`` and ``attitude`` are given and relative to which the velocities are given:
    W, the local orbital frame L (x radial outward, y along track, z along the orbital angular momentum), the
    axes of the path (L if it defines no attitude), or ``SYSTEM/FRAME``, a frame of another system in its
    initial state."""
    position: Length3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    attitude: Attitude | None = None
    linear_velocity: Speed3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Velocity of the base's origin relative to ``frame``, m/s, in body axes."""
    angular_velocity: AngularRate3 = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    """Angular velocity of the base relative to ``frame``, rad/s, in body axes."""
    joints: JointPositions = Field(default_factory=list)
    """Joint positions in the order of the model's joints, or by name."""
    joint_rates: JointRates = Field(default_factory=list)

    @property
    def neighbour(self) -> tuple[str, str] | None:
        """Names of the system and of its frame if ``frame`` is ``SYSTEM/FRAME``, otherwise None."""
        system, slash, frame = self.frame.partition("/")
        return (system, frame) if slash else None

    def build(
        self, model: Model, orbit: Orbit | None, neighbour: Neighbour | None = None
    ) -> tuple[Floats, Floats]:
        """Return the configuration and the velocity of the robot at time zero.

        A position `p_l` and an attitude relative to L are rotated by `R_il` from L to inertial axes, and the
        rotation of L is added to the given velocities `v` and `ω` in body axes: `ω_b = ω + R_bl ω_l` and `v_b
        = v + R_bl (ω_l × p_l)`, with the rate `ω_l` in the axes of L and the rotation `R_bl` from L to body
        axes. The axes of a path take the place of L if ``frame`` is ``path``. The velocity of a frame of the
        system ``neighbour`` is added in the same way.

        Returns
        -------
        q : (nq,) array
            Base position in m, base quaternion xyzw, joint positions in rad or m.
        v : (nv,) array
            Base twist in body axes, m/s and rad/s; joint rates in rad/s or m/s.

        Raises
        ------
        FrameError
            If a joint does not exist; the message suggests a similar name, if there is one.
        ShapeError
            If a list of joints has the wrong length.
        QuantityError
            If a revolute joint has a value in a unit of length, or a prismatic joint in a unit of angle.
        """
        q, v = np.array(model.neutral(), dtype=np.float64), np.zeros(model.nv)
        rot_fb = matrix_from_quaternion(quaternion_of(self.attitude))
        position, linear, angular = (
            np.array(values) for values in (self.position, self.linear_velocity, self.angular_velocity)
        )
        if self.neighbour is not None and neighbour is not None:
            name = self.neighbour[1]
            pose_wf = np.asarray(neighbour.model.frame_pose(neighbour.q, name))
            twist = np.asarray(neighbour.model.frame_velocity(neighbour.q, neighbour.v, name))
            rot_wf = pose_wf[:3, :3]
            velocity, rate = rot_wf.T @ twist[LINEAR], rot_wf.T @ twist[ANGULAR]
            linear = linear + rot_fb.T @ (velocity + np.cross(rate, position))
            angular = angular + rot_fb.T @ rate
            position, rot_fb = pose_wf[:3, 3] + rot_wf @ position, rot_wf @ rot_fb
        elif self.frame != "world" and orbit is not None:
            frame = orbit.lvlh(0.0) if self.frame == "lvlh" else orbit.frame(0.0)
            rot_il, rate = (np.asarray(value, dtype=np.float64) for value in frame)
            linear = linear + rot_fb.T @ np.cross(rate, position)
            angular = angular + rot_fb.T @ rate
            position, rot_fb = rot_il @ position, rot_il @ rot_fb
        q[POSITION], q[QUATERNION] = position, quaternion_from_matrix(rot_fb)
        v[LINEAR], v[ANGULAR] = linear, angular
        q[JOINTS_Q] = joint_values("joints", self.joints, q[JOINTS_Q], model)
        v[JOINTS_V] = joint_values("joint_rates", self.joint_rates, v[JOINTS_V], model)
        return q, v
