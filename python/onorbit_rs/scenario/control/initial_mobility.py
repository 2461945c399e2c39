"""Mobility (acceleration per unit effort) of a robot at the start of a run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.coordinates import BASE_NV, BASE_V
from onorbit_rs.scenario.control.selection import joint_columns, tool_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class InitialMobility:
    """A robot at the start of a run, and the tool and reference of the scenario."""

    model: Model
    q: Floats
    """Initial configuration (nq,)."""
    tool: str | None
    reference: Any

    def joint_count(self, law: Any) -> int:
        """Return the number of joints that a control law drives."""
        return len(joint_columns(law, self.model.joint_names))

    def of_joints(self, law: Any) -> Floats:
        """Return the mobility `(Mmm - Mmb Mbb⁻¹ Mbm)⁻¹` of the joints `m` of a law; other joints are fixed.

        The blocks are those of the mass matrix; `b` is the base.

        The mobility is at least as large if the other joints are free.
        """
        mass = np.asarray(self.model.mass_matrix(self.q))
        rows = [BASE_NV + column for column in joint_columns(law, self.model.joint_names)]
        coupling = mass[BASE_V][:, rows]
        inertia = mass[np.ix_(rows, rows)] - coupling.T @ np.linalg.solve(mass[BASE_V, BASE_V], coupling)
        return np.asarray(np.linalg.inv(inertia), dtype=np.float64)

    def of_tool(self, law: Any) -> Floats:
        """Return `Jg M*⁻¹ Jgᵀ`, (6, 6), the acceleration of a law's tool per unit wrench on the tool.

        `Jg` is the generalized Jacobian of the tool, and `M*` the reduced mass matrix of the law's joints.
        """
        tool = tool_of(law, self.tool)
        assert tool is not None  # check_control rejects a task-space law without a tool
        columns = joint_columns(law, self.model.joint_names)
        reduced = self.model.free_floating(self.q, np.zeros(self.model.nv), tool)
        jacobian = np.asarray(reduced.jacobian)[:, columns]
        mobility: Floats = jacobian @ self.of_joints(law) @ jacobian.T
        return mobility

    def is_in_w(self, law: Any) -> bool:
        """Return True unless a law's reference is relative to the base, which requires another Jacobian."""
        return getattr(getattr(law, "reference", None) or self.reference, "frame", None) != "base"


def square(gain: Any, size: int) -> Floats:
    """Return a gain as a matrix (size, size); ``gain`` is one number, the diagonal, or the matrix."""
    gain = np.asarray(gain, dtype=np.float64)
    return gain if gain.ndim == 2 else np.diag(np.broadcast_to(gain, size))
