"""Base class of controllers written in Python."""

from __future__ import annotations

import reprlib
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

from onorbit_rs import _core

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Controller(ABC):
    """Controller written in Python, for :class:`onorbit_rs.Simulation` as ``controller=``.

    A subclass must define ``update``. An exception that ``update`` raises ends the run and is re-raised
    unchanged by ``run``. Inheriting from this class is optional.

    Examples
    --------
    >>> class Brake(Controller):
    ...     def update(self, t, state):
    ...         return -0.5 * state.v[6:]
    """

    def __repr__(self) -> str:
        """Return the class and the attributes, shortened."""
        values = ", ".join(f"{name}={reprlib.repr(value)}" for name, value in vars(self).items())
        return f"{type(self).__name__}({values})" if len(values) < 200 else f"{type(self).__name__}(…)"

    def reset(self) -> None:  # noqa: B027  # most controllers have no state
        """Clear the state of a previous run; called at the start of every run."""

    def get_state(self) -> Any:
        """Return the state for a checkpoint; by default a mapping of all attributes.

        Immutable objects of onorbit_rs (models, orbits, references, ...) are omitted by default, since the
        constructor creates them.

        Returns
        -------
        plain data
            Numbers, text, lists, tuples, mappings and numeric NumPy arrays, possibly nested. For any other
            type, the run issues a warning and writes no checkpoints.
        """
        return {name: value for name, value in vars(self).items() if not _is_fixed(value)}

    def set_state(self, state: Any) -> None:
        """Restore the state of a checkpoint: by default, set the attributes that the state contains.

        Parameters
        ----------
        state : plain data
            State that :meth:`get_state` returned.
        """
        vars(self).update(state)

    @abstractmethod
    def update(self, t: float, state: Any) -> ArrayLike:
        """Return the joint torques, which are held until the next call.

        Parameters
        ----------
        t : float
            Simulated time, s.
        state : State
            ``q`` (nq,): base position (m, W), base quaternion xyzw, joint positions (rad or m);
            ``v`` (nv,): base twist (m/s and rad/s, body axes), joint rates (rad/s or m/s);
            ``joints``: names of the controlled joints: those of the joint group, otherwise all;
            ``reference_pose`` (4, 4), ``reference_velocity`` (6,), ``reference_acceleration`` (6,): desired
            motion of the tool, linear part first, m and rad, in W, or relative to the base for a reference
            in the frame ``"base"``; None without a reference.

        Returns
        -------
        (n,) array
            Torque of each joint in ``state.joints``, N m (N for a prismatic joint).
        """


_FIXED = (
    _core.Model, _core.Orbit, _core.Earth, _core.Effect, _core.Surface, _core.Atmosphere, _core.Reference,
    _core.JointReference, _core.Goal,
)  # fmt: skip


def _is_fixed(value: object) -> bool:
    """Return whether a value is an immutable object of the compiled module, such as a model."""
    return isinstance(value, _FIXED) and type(value).__module__ in ("onorbit_rs", "onorbit_rs._core")
