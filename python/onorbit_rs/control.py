"""Your own controller: a class with ``update``."""

from __future__ import annotations

import pickle
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

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

    def get_state(self) -> bytes:
        """What a checkpoint keeps: all attributes, pickled; override where they do not pickle.

        Returns
        -------
        bytes
        """
        return pickle.dumps(self.__dict__)

    def set_state(self, state: bytes) -> None:
        """Go on from a checkpoint.

        Parameters
        ----------
        state : bytes
            What :meth:`get_state` gave; the checkpoint must be your own, as unpickling runs what it says.
        """
        self.__dict__.update(pickle.loads(state))

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
