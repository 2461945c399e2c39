"""A trace that was read from a file, and the check that its columns have consistent shapes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from onorbit_rs._core import COLUMNS
from onorbit_rs.common.coordinates import BASE_NQ
from onorbit_rs.output.columns import row_shape, split_path
from onorbit_rs.output.saved_column import SavedContact, SavedLoop


@dataclass(frozen=True)
class SavedTrace:
    """Trace read from a file; its columns are attributes, named as in :class:`onorbit_rs.Trace`.

    ``arrays`` maps the path of each column to its values.
    """

    arrays: Mapping[str, Any]

    def __getattr__(self, name: str) -> Any:
        """Return a column; None if the run did not record it."""
        if name.startswith("__") or name == "arrays" or (name not in COLUMNS and name not in self.arrays):
            raise AttributeError(f"the trace has no column {name!r}; columns() lists its columns")
        return self.arrays.get(name)

    def columns(self) -> list[str]:
        """Return the names of the columns that belong to no control, effect, contact or loop.

        ``rereferenced`` is left out.
        """
        return [path for path in self.arrays if split_path(path)[1] is None and path != "rereferenced"]

    @property
    def tracking(self) -> dict[str, Any]:
        """Tracking errors by the name of the control, as in :class:`onorbit_rs.Trace`.

        They are (T, 6), m and rad, for a tool; (T, k), rad or m, for k joints (rad/s or m/s for a
        ``joint_pid`` with the interface ``velocity``); and (T, 1), N, for a grip force.
        """
        return self._by_owner("tracking")

    @property
    def wrenches(self) -> dict[str, Any]:
        """Wrenches (T, bodies, 6), N and N m, by the name of the effect, as in :class:`onorbit_rs.Trace`."""
        return self._by_owner("wrenches")

    @property
    def contacts(self) -> dict[str, SavedContact]:
        """Contacts of which the system is the first side, by their names."""
        return {name: SavedContact(values) for name, values in self._by_owner("contacts").items()}

    @property
    def loops(self) -> dict[str, SavedLoop]:
        """Closed loops whose first frame belongs to the system, by their names."""
        return {name: SavedLoop(values) for name, values in self._by_owner("loops").items()}

    def _by_owner(self, wanted: str) -> dict[str, Any]:
        found = ((*split_path(path), values) for path, values in self.arrays.items())
        return {owner: values for name, owner, values in found if owner is not None and name == wanted}


def check_shapes(arrays: Mapping[str, Any]) -> None:
    """Check that the shape of every column agrees with the number of rows and of joints.

    Raises
    ------
    ValueError
        If a column has another shape; the message names the first such column.
    """
    rows, joints = np.shape(arrays["time"]), max((np.shape(arrays["q"]) or (0,))[-1] - BASE_NQ, 0)
    if len(rows) != 1 or rows[0] == 0:
        raise ValueError(f"column 'time' has shape {rows}; expected one dimension with at least one row")
    for path, values in arrays.items():
        name, _ = split_path(path)
        if name == "rereferenced":
            continue
        shape = np.shape(values)
        row = row_shape(name, joints) if name in COLUMNS else (-1,)
        wanted = shape[1:] if -1 in row else row
        if shape != (*rows, *wanted):
            raise ValueError(f"column {path!r} has shape {shape}; expected {(*rows, *wanted)}")
