"""MuJoCo as the plant of a run."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from onorbit_rs.exceptions import PlantError
from onorbit_rs.plants.mujoco_model import engine, link, mujoco_model
from onorbit_rs.plants.mujoco_quiet import unlogged

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]
    Wrenches = Callable[[float, Floats, Floats], Floats]

_STAGES = (0.0, 0.5, 0.5, 1.0)
_WEIGHTS = np.array([1.0, 2.0, 2.0, 1.0]) / 6.0


class Mujoco:
    """A robot that MuJoCo moves: ``onorbit_rs.Simulation(..., plant=Mujoco(model))``.

    ``rk4`` is the Runge-Kutta of MuJoCo 4, with the environment's wrenches at every stage; nothing in it
    carries momentum, which drifts with its fourth order. ``semi_implicit_euler`` is MuJoCo's ``Euler``,
    implicit in joint damping. Friction and stops are MuJoCo's, soft, at their hardest; stops give hardly
    anything back. One simulation at a time may run on it; a step that meets another is refused. MuJoCo's log,
    which belongs to the whole process, is quiet during a step, and after it as it was.

    Parameters
    ----------
    model : Model
    time_step : float
        Longest step of the run, s.
    integrator : str
        ``rk4`` or ``semi_implicit_euler``.
    enforce_limits : bool
        Stops at the joints' position limits.

    Raises
    ------
    PlantError
        MuJoCo is not installed, or has no such integrator.
    ModelError
        A robot that MuJoCo cannot have.
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
            raise PlantError(
                f"MuJoCo has no integrator '{integrator}'; take 'rk4' or 'semi_implicit_euler'",
                name="integrator", got=integrator, expected=("rk4", "semi_implicit_euler"),
            )  # fmt: skip
        self._mujoco = engine()
        self._is_euler = integrator == "semi_implicit_euler"
        self._model = mujoco_model(model, time_step=time_step, enforce_limits=enforce_limits)
        self._data = self._mujoco.MjData(self._model)
        self._bodies = np.array([self._model.body(link(name)).id for name in model.body_names])
        joints = [self._model.joint(name) for name in model.joint_names]
        self._dofs = np.array([joint.dofadr[0] for joint in joints], dtype=int)
        # their quaternion is wxyz
        self._places = np.array([0, 1, 2, 4, 5, 6, 3, *(joint.qposadr[0] for joint in joints)])
        self._rates = np.array([*range(6), *self._dofs])
        self._stepping = threading.Lock()

    @property
    def version(self) -> str:
        """MuJoCo's."""
        return str(self._mujoco.__version__)

    def step(
        self, start: float, end: float, q: Floats, v: Floats, tau: Floats, wrenches: Wrenches
    ) -> tuple[Floats, Floats, Floats, Floats, float, float]:
        """Across a step under held torques; one of no length gives the acceleration alone.

        Parameters
        ----------
        start, end : float
            s.
        q : (nq,) array
            m, quaternion xyzw, joints in rad or m.
        v : (nv,) array
            Base in its own axes, linear first, m/s and rad/s; joint rates.
        tau : (nv - 6,) array
            Held at the joints over the step, N m or N.
        wrenches : callable
            ``wrenches(t, q, v)``, (bodies, 6): the environment's force and torque about the centre of mass of
            each body, axes of W, N and N m.

        Returns
        -------
        q : (nq,) array
            At the end.
        v : (nv,) array
            At the end.
        acceleration : (nv,) array
            ``v̇`` at the start, m/s² and rad/s², rad/s² or m/s².
        impulse : (6,) array
            Integral of the environment's force, then of its torque about the centre of mass of the whole;
            axes of W, N s and N m s.
        work : float
            Of motors and environment, less what the joints lost, J.
        loss : float
            At the joints, by damping, friction and stops, J.

        Raises
        ------
        PlantError
            Another simulation is in a step of it, or MuJoCo gave up.
        """
        if not self._stepping.acquire(blocking=False):
            raise PlantError(
                "another simulation is running on this plant: give each its own Mujoco(model)",
                name="plant", got="mujoco",
            )  # fmt: skip
        try:
            with unlogged(self._mujoco), np.errstate(all="ignore"):  # of a run that diverges, which is told
                return self._step(start, end, q, v, tau, wrenches)
        finally:
            self._stepping.release()

    def _step(
        self, start: float, end: float, q: Floats, v: Floats, tau: Floats, wrenches: Wrenches
    ) -> tuple[Floats, Floats, Floats, Floats, float, float]:
        h, nv = end - start, self._model.nv
        qpos, qvel = self._theirs(q, v)
        self._data.qfrc_applied[self._dofs] = tau
        first = mean = self._rate(start, qpos, qvel, wrenches)
        acceleration = self._our_acceleration(qpos, first)
        if h > 0.0 and self._is_euler:
            self._model.opt.timestep = h
            self._mujoco.mj_Euler(self._model, self._data)
            qpos, qvel = self._data.qpos, self._data.qvel
        elif h > 0.0:
            rates = [first]
            for share in _STAGES[1:]:
                turn = share * h * rates[-1][3:6]
                stage = self._moved(qpos, qvel, share * h, rates[-1])
                rates.append(self._rate(start + share * h, *stage, wrenches))
                rates[-1][3:6] = _turning(turn, rates[-1][3:6])
            mean = _WEIGHTS @ np.array(rates)
            qpos, qvel = self._moved(qpos, qvel, h, mean)
        done = h * mean[2 * nv :]
        return (*self._ours(qpos, qvel), acceleration, done[:6], float(done[6]), float(done[7]))

    def _moved(self, qpos: Floats, qvel: Floats, h: float, rate: Floats) -> tuple[Floats, Floats]:
        """`h` further at a rate, as MuJoCo's stages move."""
        nv, moved = self._model.nv, qpos.copy()
        self._mujoco.mj_integratePos(self._model, moved, rate[:nv], h)
        return moved, qvel + h * rate[nv : 2 * nv]

    def _rate(self, t: float, qpos: Floats, qvel: Floats, wrenches: Wrenches) -> Floats:
        """``[qvel, qacc, ΣF, ΣT about the centre of mass, power, loss at the joints]``."""
        data = self._data
        if not (np.isfinite(qpos).all() and np.isfinite(qvel).all()):
            return np.full(2 * self._model.nv + 8, np.nan)  # the run diverges: MuJoCo would write a log file
        outer = wrenches(t, *self._ours(qpos, qvel))
        data.qpos[:], data.qvel[:] = qpos, qvel
        data.xfrc_applied[self._bodies] = outer
        try:
            self._mujoco.mj_forward(self._model, data)
        except self._mujoco.FatalError as error:
            raise PlantError(f"MuJoCo gave up at t = {t:g} s: {error}", name="plant", got="mujoco") from error
        force, arm = outer[:, :3], data.xipos[self._bodies] - data.subtree_com[self._bodies[0]]
        moment = (
            outer[:, 3:] + arm[:, [1, 2, 0]] * force[:, [2, 0, 1]] - arm[:, [2, 0, 1]] * force[:, [1, 2, 0]]
        )
        power = (data.qfrc_smooth + data.qfrc_bias + data.qfrc_constraint) @ qvel
        loss = -(data.qfrc_passive + data.qfrc_constraint) @ qvel
        return np.concatenate([qvel, data.qacc, force.sum(axis=0), moment.sum(axis=0), [power, loss]])

    def _theirs(self, q: Floats, v: Floats) -> tuple[Floats, Floats]:
        """``[p, quat wxyz, joints]`` and ``[ṗ in W, w in B, rates]``."""
        qpos, qvel = np.empty_like(q), np.empty_like(v)
        qpos[self._places], qvel[self._rates] = q, v
        qvel[:3] = self._rot_wb(qpos) @ v[:3]
        return qpos, qvel

    def _ours(self, qpos: Floats, qvel: Floats) -> tuple[Floats, Floats]:
        q, v = qpos[self._places], qvel[self._rates]
        v[:3] = qvel[:3] @ self._rot_wb(qpos)
        return q, v

    def _our_acceleration(self, qpos: Floats, rate: Floats) -> Floats:
        """With `v = Rᵀ ṗ`: `v̇ = Rᵀ p̈ − w × v`."""
        nv, rot_wb = self._model.nv, self._rot_wb(qpos)
        a: Floats = rate[nv : 2 * nv][self._rates]
        a[:3] = a[:3] @ rot_wb - _cross(rate[3:6], rate[:3] @ rot_wb)
        return a

    def _rot_wb(self, qpos: Floats) -> Any:
        flat = np.empty(9)
        self._mujoco.mju_quat2Mat(flat, qpos[3:7])
        return flat.reshape(3, 3)


def _turning(turn: Floats, w: Floats) -> Floats:
    """Rate of the rotation vector of a turn at `w` in its own axes: `w + u × w / 2 + u × (u × w) / 12`."""
    across = _cross(turn, w)
    rate: Floats = w + across / 2.0 + _cross(turn, across) / 12.0
    return rate


def _cross(a: Floats, b: Floats) -> Floats:
    """As numpy's, which takes ten times as long for one pair."""
    (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])
