"""Converts configurations and velocities to and from the conventions of other engines.

`p` is the position of the base's origin in the world W; `v` and `w` are the base's linear and angular
velocity. The letter after `v` or `w` names the axes: B base, W world.

==============  ========================================  ======================================
engine          configuration                             velocity
==============  ========================================  ======================================
onorbit_rs      ``p, quat xyzw, joints``                  ``v_B, w_B, rates``
``pinocchio``   the same, unbounded joints as cos, sin    ``v_B, w_B, rates``
``mujoco``      ``p, quat wxyz, joints``                  ``v_W, w_B, rates``
``drake``       ``quat wxyz, p, joints``                  ``w_W, v_W, rates``
``rbdl``        ``p, quat xyz, joints, quat w``           ``v_W, w_B, rates``
``spart``       ``(R0, r0, qm)``, ``r0`` mass centre      ``(u0, um)``, ``u0 = w_B, dr0/dt``
==============  ========================================  ======================================

For each engine there is ``to_engine(model, q, v)`` and its inverse ``from_engine(model, q, v)``; SPART uses
the tuples in the table. They accept one state ``(n,)`` or a batch ``(B, n)``. The order of joints differs
between engines (Pinocchio sorts siblings by name): ``joints=`` is a list of their names in the order of the
other engine or, for Pinocchio, MuJoCo and Drake, the model of that engine. The default is the order of
onorbit_rs. The base must be the same link in both engines.

>>> import onorbit_rs as oo
>>> model = oo.Model.rigid_body(1.0, [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
>>> qpos, qvel = oo.layouts.to_mujoco(model, model.neutral(), [0.1, 0, 0, 0, 0, 0.2])
>>> qpos
array([0., 0., 0., 1., 0., 0., 0.])
"""

from __future__ import annotations

from onorbit_rs.layouts.drake import from_drake, to_drake
from onorbit_rs.layouts.mujoco import from_mujoco, to_mujoco
from onorbit_rs.layouts.pinocchio import from_pinocchio, to_pinocchio
from onorbit_rs.layouts.rbdl import from_rbdl, to_rbdl
from onorbit_rs.layouts.spart import from_spart, to_spart

__all__ = [
    "from_drake",
    "from_mujoco",
    "from_pinocchio",
    "from_rbdl",
    "from_spart",
    "to_drake",
    "to_mujoco",
    "to_pinocchio",
    "to_rbdl",
    "to_spart",
]
