"""MuJoCo as the engine of a run."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from onorbit_rs.common.coordinates import ANGULAR, LINEAR, QUATERNION
from onorbit_rs.engines.mujoco_log import without_log
from onorbit_rs.engines.mujoco_model import import_mujoco, link_name, mujoco_model
from onorbit_rs.exceptions import EngineError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]
    Wrenches = Callable[[float, Floats, Floats], Floats]

_STAGES = (0.0, 0.5, 0.5, 1.0)
_WEIGHTS = np.array([1.0, 2.0, 2.0, 1.0]) / 6.0


class Mujoco:
    """Engine that integrates the robot with MuJoCo: ``onorbit_rs.Simulation(..., engine=Mujoco(model))``.

    ``rk4`` is the Runge-Kutta method of MuJoCo 4, with the environment's wrenches evaluated at every stage.
    It does not project momentum, so momentum drifts with fourth order in the step. ``semi_implicit_euler`` is
    MuJoCo's ``Euler``, implicit in joint damping. Joint friction and stops are MuJoCo's soft constraints with
    their stiffest settings; the restitution of stops is close to zero. One simulation at a time may use an
    instance; a concurrent step is refused. MuJoCo's log settings, which are global to the process, are
    disabled during a step and restored after it.

    Parameters
    ----------
    model : Model
    time_step : float
        Longest step of the run, s.
    integrator : str
        ``rk4`` or ``semi_implicit_euler``.
    enforce_limits : bool
        Whether rigid stops keep the joints within their position limits.

    Raises
    ------
    EngineError
        If MuJoCo is not installed or has no such integrator.
    ModelError
        If MuJoCo cannot represent the robot.
    """

    def __init__(
        self,
        model: Model,
        *,
        time_step: float = 1e-3,
        integrator: Literal["rk4", "semi_implicit_euler"] = "rk4",
        enforce_limits: bool = False,
    ) -> None:
        """Build MuJoCo's model of the robot."""
        if integrator not in ("rk4", "semi_implicit_euler"):
            raise EngineError(
                f"integrator '{integrator}' is not available with MuJoCo; use 'rk4' or 'semi_implicit_euler'",
                name="integrator", got=integrator, expected=("rk4", "semi_implicit_euler"),
            )  # fmt: skip
        self._mujoco = import_mujoco()
        self._is_euler = integrator == "semi_implicit_euler"
        self._model = mujoco_model(model, time_step=time_step, enforce_limits=enforce_limits)
        self._data = self._mujoco.MjData(self._model)
        self._bodies = np.array([self._model.body(link_name(name)).id for name in model.body_names])
        joints = [self._model.joint(name) for name in model.joint_names]
        self._dofs = np.array([joint.dofadr[0] for joint in joints], dtype=int)
        # MuJoCo's quaternion is wxyz
        self._q_columns = np.array([0, 1, 2, 4, 5, 6, 3, *(joint.qposadr[0] for joint in joints)])
        self._v_columns = np.array([*range(6), *self._dofs])
        self._lock = threading.Lock()

    @property
    def version(self) -> str:
        """Version of MuJoCo."""
        return str(self._mujoco.__version__)

    def step(
        self, start: float, end: float, q: Floats, v: Floats, tau: Floats, wrenches: Wrenches
    ) -> tuple[Floats, Floats, Floats, Floats, float, float]:
        """Integrate one step with constant joint torques; a step of length zero computes v̇ only.

        Parameters
        ----------
        start, end : float
            Time at the ends of the step, s.
        q : (nq,) array
            Base position in m, base quaternion xyzw, joints in rad or m.
        v : (nv,) array
            Base twist in body axes, linear first, m/s and rad/s; joint rates.
        tau : (nv - 6,) array
            Joint torques over the step, N m or N.
        wrenches : callable
            ``wrenches(t, q, v)`` returns the environment's force on each body and its torque about the body's
            centre of mass, (bodies, 6), axes of W, N and N m.

        Returns
        -------
        q : (nq,) array
            Configuration at the end.
        v : (nv,) array
            Velocity at the end.
        acceleration : (nv,) array
            ``v̇`` at the start, m/s² and rad/s², rad/s² or m/s².
        impulse : (6,) array
            Integral of the environment's force and of its torque about the robot's centre of mass, axes of
            W, N s and N m s.
        work : float
            Work of motors and environment minus the energy dissipated in the joints, J.
        loss : float
            Energy dissipated in the joints by damping, friction and stops, J.

        Raises
        ------
        EngineError
            If another simulation is in a step of this instance, or MuJoCo raises a fatal error.
        """
        if not self._lock.acquire(blocking=False):
            raise EngineError(
                "this engine is in use by another simulation; create one Mujoco(model) for each simulation",
                name="engine", got="mujoco",
            )  # fmt: skip
        try:
            # numpy's warnings in a diverging run are redundant: the run raises an error
            with without_log(self._mujoco), np.errstate(all="ignore"):
                return self._step(start, end, q, v, tau, wrenches)
        finally:
            self._lock.release()

    def _step(
        self, start: float, end: float, q: Floats, v: Floats, tau: Floats, wrenches: Wrenches
    ) -> tuple[Floats, Floats, Floats, Floats, float, float]:
        h, nv = end - start, self._model.nv
        qpos, qvel = self._to_mujoco(q, v)
        self._data.qfrc_applied[self._dofs] = tau
        first = mean = self._rate(start, qpos, qvel, wrenches)
        acceleration = self._acceleration(qpos, first)
        if h > 0.0 and self._is_euler:
            self._model.opt.timestep = h
            self._mujoco.mj_Euler(self._model, self._data)
            qpos, qvel = self._data.qpos, self._data.qvel
        elif h > 0.0:
            rates = [first]
            for fraction in _STAGES[1:]:
                rotation = fraction * h * rates[-1][ANGULAR]
                stage = self._moved(qpos, qvel, fraction * h, rates[-1])
                rates.append(self._rate(start + fraction * h, *stage, wrenches))
                rates[-1][ANGULAR] = _rotation_vector_rate(rotation, rates[-1][ANGULAR])
            mean = _WEIGHTS @ np.array(rates)
            qpos, qvel = self._moved(qpos, qvel, h, mean)
        done = h * mean[2 * nv :]
        return (*self._from_mujoco(qpos, qvel), acceleration, done[:6], float(done[6]), float(done[7]))

    def _moved(self, qpos: Floats, qvel: Floats, h: float, rate: Floats) -> tuple[Floats, Floats]:
        """Return the state advanced by `h` at a constant rate, as in MuJoCo's stages."""
        nv, moved = self._model.nv, qpos.copy()
        self._mujoco.mj_integratePos(self._model, moved, rate[:nv], h)
        return moved, qvel + h * rate[nv : 2 * nv]

    def _rate(self, t: float, qpos: Floats, qvel: Floats, wrenches: Wrenches) -> Floats:
        """Return ``[qvel, qacc, ΣF, ΣT about the centre of mass, power, power dissipated in the joints]``."""
        data = self._data
        if not (np.isfinite(qpos).all() and np.isfinite(qvel).all()):
            return np.full(2 * self._model.nv + 8, np.nan)  # MuJoCo would write a log file
        outer = wrenches(t, *self._from_mujoco(qpos, qvel))
        data.qpos[:], data.qvel[:] = qpos, qvel
        data.xfrc_applied[self._bodies] = outer
        try:
            self._mujoco.mj_forward(self._model, data)
        except self._mujoco.FatalError as error:
            raise EngineError(
                f"MuJoCo failed at t = {t:g} s: {error}", name="engine", got="mujoco"
            ) from error
        force, arm = outer[:, :3], data.xipos[self._bodies] - data.subtree_com[self._bodies[0]]
        moment = (
            outer[:, 3:] + arm[:, [1, 2, 0]] * force[:, [2, 0, 1]] - arm[:, [2, 0, 1]] * force[:, [1, 2, 0]]
        )
        power = (data.qfrc_smooth + data.qfrc_bias + data.qfrc_constraint) @ qvel
        loss = -(data.qfrc_passive + data.qfrc_constraint) @ qvel
        return np.concatenate([qvel, data.qacc, force.sum(axis=0), moment.sum(axis=0), [power, loss]])

    def _to_mujoco(self, q: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return MuJoCo's ``[p, quat wxyz, joints]`` and ``[ṗ in W, w in B, rates]``."""
        qpos, qvel = np.empty_like(q), np.empty_like(v)
        qpos[self._q_columns], qvel[self._v_columns] = q, v
        qvel[:3] = self._rot_wb(qpos) @ v[:3]
        return qpos, qvel

    def _from_mujoco(self, qpos: Floats, qvel: Floats) -> tuple[Floats, Floats]:
        q, v = qpos[self._q_columns], qvel[self._v_columns]
        v[:3] = qvel[:3] @ self._rot_wb(qpos)
        return q, v

    def _acceleration(self, qpos: Floats, rate: Floats) -> Floats:
        """Return the derivative of `v`; with `v = Rᵀ ṗ`, `v̇ = Rᵀ p̈ − w × v`."""
        nv, rot_wb = self._model.nv, self._rot_wb(qpos)
        a: Floats = rate[nv : 2 * nv][self._v_columns]
        a[LINEAR] = a[LINEAR] @ rot_wb - _cross(rate[ANGULAR], rate[LINEAR] @ rot_wb)
        return a

    def _rot_wb(self, qpos: Floats) -> Any:
        flat = np.empty(9)
        self._mujoco.mju_quat2Mat(flat, qpos[QUATERNION])
        return flat.reshape(3, 3)


def _rotation_vector_rate(u: Floats, w: Floats) -> Floats:
    """Return the rate of a rotation vector `u` at body rate `w`: `w + u × w / 2 + u × (u × w) / 12`."""
    cross = _cross(u, w)
    rate: Floats = w + cross / 2.0 + _cross(u, cross) / 12.0
    return rate


def _cross(a: Floats, b: Floats) -> Floats:
    """Return `a × b`; for a single pair ten times as fast as numpy."""
    (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])
