"""Columns of the trace that a campaign keeps, at the recorded or a lower rate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs._core import WorldTrace
from onorbit_rs.output.pickling import arrays_of
from onorbit_rs.output.world import world_arrays

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.campaigns.document import Keep

    Floats = NDArray[np.float64]


def columns_of(trace: Any) -> dict[str, Floats]:
    """Return the numeric columns of a trace with one row per recorded time, as named in ``trace.npz``.

    The columns of events are left out.
    """
    arrays = world_arrays(trace) if isinstance(trace, WorldTrace) else arrays_of(trace)
    rows = len(arrays["time"])
    return {
        name: np.asarray(values, dtype=np.float64)
        for name, values in arrays.items()
        if len(values) == rows and np.asarray(values).dtype.kind in "fiub" and not name.startswith("events/")
    }


def kept_columns(trace: Any, keep: Keep) -> dict[str, Floats]:
    """Return ``time`` and one column per component of each kept column, such as ``q[0]``.

    The result is empty if the campaign keeps no columns.
    """
    if not keep.columns:
        return {}
    arrays = columns_of(trace)
    chosen = rows_every(arrays["time"], keep.every)
    found = {"time": arrays["time"][chosen]}
    for name in keep.columns:
        values = arrays[name][chosen]
        flat = values.reshape(len(values), -1)
        if values.ndim == 1:
            found[name] = values
            continue
        indices = np.ndindex(values.shape[1:])
        found |= {
            f"{name}[{','.join(map(str, index))}]": np.ascontiguousarray(flat[:, column])
            for column, index in enumerate(indices)
        }
    return found


def rows_every(time: Floats, every: float | None) -> NDArray[np.intp]:
    """Return the indices of rows at intervals of ``every``, s; those of all rows if it is None.

    They are the first row at or after each multiple of ``every`` from the first time, and the last row.
    """
    if every is None:
        return np.arange(len(time))
    count = int(np.floor((time[-1] - time[0]) / every * (1.0 + 1e-12)))
    wanted = time[0] + every * np.arange(count + 1)
    found = np.searchsorted(time, wanted - 1e-9 * every)
    rows: NDArray[np.intp] = np.unique([*found[found < len(time)], len(time) - 1])
    return rows
