"""Your own controller: a class with ``update``."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

from onorbit_rs import _core

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Controller(ABC):
    """Base class of controllers written in Python.

    Give one to :class:`onorbit_rs.Simulation` as ``controller=``. An exception raised in ``update`` stops the
    run and comes out of ``run`` as itself. One without ``update`` cannot be made.

    Examples
    --------
    >>> class Brake(Controller):
    ...     def update(self, t, state):
    ...         return -0.5 * state.v[6:]
    """

    def reset(self) -> None:  # noqa: B027  # most have nothing to forget
        """Called at the start of every run; forget what an earlier run left behind."""

    def get_state(self) -> Any:
        """Return what a checkpoint keeps: plain data, by default a mapping of all attributes.

        Numbers, text, lists, tuples, mappings and numeric NumPy arrays, nested as you like; the run warns and
        leaves no checkpoints if there is anything else. Objects of onorbit_rs that never change (a model, an
        orbit, a reference, ...) are left out by default: the constructor makes them again.

        Returns
        -------
        plain data
        """
        return {name: value for name, value in vars(self).items() if not _is_fixed(value)}

    def set_state(self, state: Any) -> None:
        """Continue from a checkpoint; by default sets the attributes that it holds.

        Parameters
        ----------
        state : plain data
            What :meth:`get_state` returned.
        """
        vars(self).update(state)

    @abstractmethod
    def update(self, t: float, state: Any) -> ArrayLike:
        """Joint torques held until the next call.

        Parameters
        ----------
        t : float
            Time of simulation, s.
        state : object with ``q``, ``v`` and ``joints``
            ``q`` (nq,): base position (m, W), base quaternion xyzw, joints (rad or m);
            ``v`` (nv,): base twist (m/s and rad/s, body axes), joint rates;
            ``joints``: names of the joints it drives, all or those of its group.

        Returns
        -------
        (n,) array
            One per name in ``state.joints``, N m (N on a prismatic joint).
        """


_FIXED = (
    _core.Model, _core.Orbit, _core.Earth, _core.Effect, _core.Surface, _core.Atmosphere, _core.Reference,
    _core.JointReference, _core.Goal,
)  # fmt: skip


def _is_fixed(value: object) -> bool:
    """Return whether a value is an object of the engine that never changes."""
    return isinstance(value, _FIXED) and type(value).__module__ in ("onorbit_rs", "onorbit_rs._core")
