"""MuJoCo as the engine of a run."""

from __future__ import annotations

import math
import threading
from collections.abc import Collection, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from onorbit_rs.common.counting import count
from onorbit_rs.engines.mujoco_brakes import Brakes
from onorbit_rs.engines.mujoco_log import without_log
from onorbit_rs.engines.mujoco_loops import loop_names
from onorbit_rs.engines.mujoco_model import import_mujoco, world_model
from onorbit_rs.engines.mujoco_pressure import WIDTH, Contacts
from onorbit_rs.engines.mujoco_share import connect, exchanged, shares
from onorbit_rs.exceptions import EngineError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from onorbit_rs._core import Contact, Model
    from onorbit_rs.engines.mujoco_brakes import Engaged
    from onorbit_rs.engines.mujoco_share import Share, Weld

    Floats = NDArray[np.float64]
    Wrenches = Callable[[float, Floats, Floats], Floats]

_STAGES = (0.0, 0.5, 0.5, 1.0)
_WEIGHTS = np.array([1.0, 2.0, 2.0, 1.0]) / 6.0


class Mujoco:
    """Engine that integrates the motion with MuJoCo: ``onorbit_rs.Simulation(..., engine=Mujoco(model))``.

    ``rk4`` is the fourth-order Runge-Kutta method of MuJoCo 4, with the environment's wrenches evaluated at
    every stage. Momentum is not projected, so its drift is of fourth order in the step.
    ``semi_implicit_euler`` is MuJoCo's ``Euler``, implicit in joint damping. Joint friction and stops are
    MuJoCo's soft constraints with their stiffest settings; the restitution of stops is close to zero. Closed
    loops and mimic joints are equalities with the same settings; a prismatic loop is rejected. An engaged
    brake is joint friction equal to its slip torque or, if that is infinite, an equality that locks the
    joint. The connections of a world are welds, also soft: a capture removes the relative velocity within a
    few steps instead of at once. Only one simulation at a time may use an instance; a concurrent step fails.
    MuJoCo's log settings, global to the process, are disabled during a step and restored after it.

    Parameters
    ----------
    model : Model or dict of str to Model
        Robot, or the models of the systems of a world by their names, in the order of the world.
    time_step : float
        Longest step of the run, s.
    integrator : str
        ``rk4`` or ``semi_implicit_euler``.
    enforce_limits : bool or list of str
        Whether rigid stops keep the joints within their position limits; for a world, the names of the
        systems with such stops.
    weld_time_constant : float, optional
        Time constant of the connections of a world (``solref`` of their welds), s, at least two time steps. A
        longer one is resolved by more steps, which reduces the error of the energy balance but permits a
        larger gap between the connected frames. Default: two time steps.
    contacts : list of Contact
        Contacts of a world; those without a normal force are ignored. MuJoCo finds the points at which links
        touch and applies the declared normal force there; friction is MuJoCo's, which creeps under any load.

    Raises
    ------
    EngineError
        If MuJoCo is not installed, the integrator is not available with MuJoCo, the time constant is out of
        range, or MuJoCo cannot represent a contact, such as one with torsional friction, or a prismatic loop.
    ModelError
        If MuJoCo cannot represent the robot.
    """

    supports_brakes = True

    def __init__(
        self,
        model: Model | Mapping[str, Model],
        *,
        time_step: float = 1e-3,
        integrator: Literal["rk4", "semi_implicit_euler"] = "rk4",
        enforce_limits: bool | Collection[str] = False,
        weld_time_constant: float | None = None,
        contacts: Sequence[Contact] = (),
    ) -> None:
        """Build MuJoCo's model of the robot or of the world."""
        if integrator not in ("rk4", "semi_implicit_euler"):
            raise EngineError(
                f"integrator '{integrator}' is not available with MuJoCo; use 'rk4' or 'semi_implicit_euler'",
                name="integrator", got=integrator, expected=("rk4", "semi_implicit_euler"),
            )  # fmt: skip
        self._mujoco = import_mujoco()
        self._is_euler = integrator == "semi_implicit_euler"
        models = dict(model) if isinstance(model, Mapping) else {"": model}
        stops = enforce_limits if isinstance(enforce_limits, Collection) else [*models] * enforce_limits
        self._is_world = isinstance(model, Mapping)
        self._compile = partial(
            world_model, models, time_step=time_step, with_stops=stops,
            weld_time_constant=weld_time_constant, contacts=contacts,
        )  # fmt: skip
        self._models = models
        self._build(len(models) - 1)
        self._bodies, self._dofs, self._q_columns, self._v_columns = (
            np.concatenate([getattr(part, name) for part in self._shares])
            for name in ("bodies", "dofs", "q_columns", "v_columns")
        )
        self._lock = threading.Lock()

    def _build(self, connections: int) -> None:
        """Build MuJoCo's model with welds for a number of connections."""
        self._connections = connections
        self._model, touches = self._compile(connections=connections)
        self._contacts = Contacts(self._mujoco, self._model, touches)
        self._data = self._mujoco.MjData(self._model)
        self._shares = shares(self._model, self._models)
        self._brakes = Brakes(self._model, self._shares, connections)

    @property
    def version(self) -> str:
        """Version of the installed MuJoCo, such as ``4.0.1``."""
        return str(self._mujoco.__version__)

    @property
    def contacts(self) -> list[str]:
        """Names of the contacts whose forces the engine computes."""
        return self._contacts.names

    @property
    def loops(self) -> list[str]:
        """Names of the represented closed loops and mimic joints; in a world, paths ``SYSTEM/NAME``."""
        return loop_names(self._models)

    def step(
        self,
        start: float,
        end: float,
        q: Floats,
        v: Floats,
        tau: Floats,
        wrenches: Wrenches,
        *,
        brakes: Sequence[Engaged] = (),
    ) -> tuple[Floats, Floats, Floats, Floats, float, float]:
        """Integrate one step with constant joint torques; a step of length zero computes v̇ only.

        Parameters
        ----------
        start, end : float
            Times of the start and the end of the step, s.
        q : (nq,) array
            Base position in m, base quaternion xyzw, joints in rad or m.
        v : (nv,) array
            Base twist in body axes, linear first, m/s and rad/s; joint rates.
        tau : (nv - 6,) array
            Joint torques over the step, N m or N.
        wrenches : callable
            ``wrenches(t, q, v)`` returns the environment's force on each body and its torque about the body's
            centre of mass, (bodies, 6), axes of W, N and N m.
        brakes : list of (int, int, float)
            Index of the system, index of its joint, and slip torque, N m or N, of each engaged brake.

        Returns
        -------
        q : (nq,) array
            Configuration at the end.
        v : (nv,) array
            Velocity at the end.
        acceleration : (nv,) array
            ``v̇`` at the start: of the base, m/s² and rad/s², then of the joints, rad/s² or m/s².
        impulse : (6,) array
            Integral of the environment's force and of its torque about the robot's centre of mass, axes of
            W, N s and N m s.
        work : float
            Work of motors, springs and environment minus the energy dissipated in the joints, J.
        loss : float
            Energy dissipated in the joints by damping, friction and stops, J.

        Raises
        ------
        EngineError
            If another simulation is in a step of this instance, or MuJoCo raises a fatal error.
        """
        qpos, qvel, acceleration, done, _ = self._advance((start, end), (q, v, tau), wrenches, [], brakes)
        return qpos, qvel, acceleration, done[:6], float(done[6]), float(done[7])

    def step_world(
        self,
        start: float,
        end: float,
        q: Floats,
        v: Floats,
        tau: Floats,
        wrenches: Wrenches,
        welds: Sequence[Weld],
        *,
        brakes: Sequence[Engaged] = (),
    ) -> tuple[Floats, ...]:
        """Integrate one step of all systems of a world; the counterpart of :meth:`step` for a world.

        Parameters
        ----------
        start, end : float
            Times of the start and the end of the step, s.
        q, v, tau : arrays
            Configurations, velocities and joint torques of the systems, one after another, units of
            :meth:`step`.
        wrenches : callable
            ``wrenches(t, q, v)`` returns the environment's wrenches on the bodies of all systems, as in
            :meth:`step`.
        welds : list
            Connections: ``(system, body)`` of both sides, the captured origin in the axes of each body,
            (2, 3), m, and the rotation from the axes of the second body to those of the first, (3, 3).
        brakes : list
            Engaged brakes, as in :meth:`step`.

        Returns
        -------
        q, v, acceleration : arrays
            As in :meth:`step`, for all systems one after another.
        impulse : (systems, 6) array
            Impulse of the environment on each system, as in :meth:`step`.
        work, loss : (systems,) arrays
            Work of motors, springs and environment minus the dissipated energy; dissipated energy; J.
        weld_impulse : (systems, 6) array
            Linear and angular impulse of welds and contacts on each system, N s and N m s.
        weld_work : (systems,) array
            Work of welds and contacts on each system, J.
        orbital : (3,) array
            Integral of the moments of the environment's forces, acting at the centres of mass of the systems,
            about the common centre of mass, axes of W, N m s.
        contacts : (contacts, 14) array
            Only with contacts: at the start the force on the second side, N, its moment about the origin of
            W, N m, and the power removed from the motion, W; then the integrals of these seven over the step.

        Raises
        ------
        EngineError
            As for :meth:`step`, or if the instance was created for other systems.
        """
        if not self._is_world or len(q) != self._model.nq or len(tau) != len(self._dofs):
            systems = count(len(self._shares), "system", "systems")
            made = f"a world of {systems}" if self._is_world else "a single robot"
            raise EngineError(
                f"this engine was created for {made} (coordinates: {self._model.nq}, joint torques: "
                f"{len(self._dofs)}), but is used for a world (coordinates: {len(q)}, joint torques: "
                f"{len(tau)}); create Mujoco({{name: model, ...}}) with all systems in the world's order",
                name="engine", got="mujoco",
            )  # fmt: skip
        qpos, qvel, acceleration, done, first = self._advance(
            (start, end), (q, v, tau), wrenches, welds, brakes
        )
        end_of_systems = 15 * len(self._shares)
        of, orbital = done[:end_of_systems].reshape(-1, 15), done[end_of_systems:][:3]
        result = (qpos, qvel, acceleration, of[:, :6], of[:, 6], of[:, 7], of[:, 8:14], of[:, 14], orbital)
        if not self.contacts:
            return result
        now, over_step = (rates[end_of_systems + 3 :].reshape(-1, WIDTH) for rates in (first, done))
        return *result, np.hstack([now, over_step])

    def _advance(
        self,
        interval: tuple[float, float],
        state: tuple[Floats, Floats, Floats],
        wrenches: Wrenches,
        welds: Sequence[Weld],
        brakes: Sequence[Engaged],
    ) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        if not self._lock.acquire(blocking=False):
            raise EngineError(
                "this engine is in use by another simulation; create one Mujoco(model) for each simulation",
                name="engine", got="mujoco",
            )  # fmt: skip
        try:
            # numpy's warnings in a diverging run are redundant: the run raises an error
            with without_log(self._mujoco), np.errstate(all="ignore"):
                if len(welds) > self._connections:  # captures that close loops
                    self._build(len(welds))
                slots = self._connections
                connect(self._mujoco, self._model, self._data, self._shares, welds, slots)
                self._contacts.release_held(self._data, slots)
                qpos, _ = self._to_mujoco(*state[:2])
                self._brakes.engage(self._data, brakes, qpos)
                return self._step(*interval, *state, wrenches)
        finally:
            self._lock.release()

    def _step(
        self, start: float, end: float, q: Floats, v: Floats, tau: Floats, wrenches: Wrenches
    ) -> tuple[Floats, Floats, Floats, Floats, Floats]:
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
                last = rates[-1]
                rotations = [fraction * h * last[part.angular] for part in self._shares]
                stage = self._moved(qpos, qvel, fraction * h, last)
                rate = self._rate(start + fraction * h, *stage, wrenches)
                for part, rotation in zip(self._shares, rotations, strict=True):
                    rate[part.angular] = _rotation_vector_rate(rotation, rate[part.angular])
                rates.append(rate)
            mean = _WEIGHTS @ np.array(rates)
            qpos, qvel = self._moved(qpos, qvel, h, mean)
        return (*self._from_mujoco(qpos, qvel), acceleration, h * mean[2 * nv :], first[2 * nv :])

    def _moved(self, qpos: Floats, qvel: Floats, h: float, rate: Floats) -> tuple[Floats, Floats]:
        """Return the state advanced by the time `h` at a constant rate, as in MuJoCo's ``RK4`` stages."""
        nv, moved = self._model.nv, qpos.copy()
        self._mujoco.mj_integratePos(self._model, moved, rate[:nv], h)
        return moved, qvel + h * rate[nv : 2 * nv]

    def _rate(self, t: float, qpos: Floats, qvel: Floats, wrenches: Wrenches) -> Floats:
        """Return ``[qvel, qacc, F, T, power, power dissipated in the joints]``, powers in W.

        `F` and `T` are the force of the environment, N, and its moment about the centre of mass, N m. In a
        world, the values of all systems follow ``qacc``; see :func:`exchanged`. A non-finite state gives NaN.
        """
        data = self._data
        if not (np.isfinite(qpos).all() and np.isfinite(qvel).all()):
            count = 15 * len(self._shares) + 3 + WIDTH * len(self.contacts) if self._is_world else 8
            return np.full(2 * self._model.nv + count, np.nan)  # MuJoCo would write a log file
        outer = wrenches(t, *self._from_mujoco(qpos, qvel))
        data.qpos[:], data.qvel[:] = qpos, qvel
        data.xfrc_applied[self._bodies] = outer
        try:
            if self.contacts:
                self._contacts.forward(data)
            else:
                self._mujoco.mj_forward(self._model, data)
        except self._mujoco.FatalError as error:
            raise EngineError(
                f"MuJoCo failed at t = {t:g} s: {error}; use a shorter time_step, or engine: native",
                name="engine",
                got="mujoco",
            ) from error
        if self._is_world:
            parts = exchanged(self._mujoco, self._model, data, self._shares, outer, self._connections)
            touching = self._contacts.output(data).ravel() if self.contacts else np.empty(0)
            return np.concatenate([qvel, data.qacc, parts, touching])
        force, arm = outer[:, :3], data.xipos[self._bodies] - data.subtree_com[self._bodies[0]]
        moment = (
            outer[:, 3:] + arm[:, [1, 2, 0]] * force[:, [2, 0, 1]] - arm[:, [2, 0, 1]] * force[:, [1, 2, 0]]
        )
        power = (data.qfrc_smooth + data.qfrc_bias + data.qfrc_constraint) @ qvel
        loss = -(data.qfrc_damper + data.qfrc_constraint) @ qvel
        return np.concatenate([qvel, data.qacc, force.sum(axis=0), moment.sum(axis=0), [power, loss]])

    def _to_mujoco(self, q: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return MuJoCo's configuration ``[p, quat wxyz, joints]`` and velocity ``[ṗ_W, w_B, rates]``."""
        qpos, qvel = np.empty_like(q), np.empty_like(v)
        qpos[self._q_columns], qvel[self._v_columns] = q, v
        for part in self._shares:
            qvel[part.linear] = self._rot_wb(qpos, part) @ v[part.linear]
        return qpos, qvel

    def _from_mujoco(self, qpos: Floats, qvel: Floats) -> tuple[Floats, Floats]:
        q, v = qpos[self._q_columns], qvel[self._v_columns]
        for part in self._shares:
            v[part.linear] = qvel[part.linear] @ self._rot_wb(qpos, part)
        return q, v

    def _acceleration(self, qpos: Floats, rate: Floats) -> Floats:
        """Return the derivative of `v`; for the linear velocity `v = Rᵀ ṗ` of a base it is `Rᵀ p̈ − w × v`."""
        nv = self._model.nv
        a: Floats = rate[nv : 2 * nv][self._v_columns]
        for part in self._shares:
            rot_wb, linear = self._rot_wb(qpos, part), part.linear
            a[linear] = a[linear] @ rot_wb - _cross(rate[part.angular], rate[linear] @ rot_wb)
        return a

    def _rot_wb(self, qpos: Floats, part: Share) -> Any:
        flat, quat = np.empty(9), qpos[part.quaternion]
        # MuJoCo accepts norms up to 1e-15 from 1, which would change the momentum in every step
        self._mujoco.mju_quat2Mat(flat, quat / math.sqrt(quat @ quat))
        return flat.reshape(3, 3)


def _rotation_vector_rate(u: Floats, w: Floats) -> Floats:
    """Return the rate of a rotation vector `u` at body rate `w`: `w + u × w / 2 + u × (u × w) / 12`."""
    cross = _cross(u, w)
    rate: Floats = w + cross / 2.0 + _cross(u, cross) / 12.0
    return rate


def _cross(a: Floats, b: Floats) -> Floats:
    """Return `a × b`, for a single pair of vectors ten times as fast as NumPy."""
    (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])
