"""Momentum of several systems, and the rows that their traces share."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def group_momentum(momenta: Sequence[Floats], centers: Sequence[Floats], masses: Sequence[float]) -> Floats:
    """Return the momentum (systems, T, 6) of each system about the common centre of mass, in axes of W.

    With the common centre of mass `c`, the angular part of system `k` is `L_k + (c_k − c) × P_k`, where `P_k`
    is its linear momentum and `L_k` its angular momentum about its own centre of mass `c_k`. The sum over the
    systems is the total momentum.

    Parameters
    ----------
    momenta : sequence of (T, 6) array, N s and N m s
        Momentum of each system, its angular part about the centre of mass of the system; axes of W.
    centers : sequence of (T, 3) array, m
        Centres of mass in W.
    masses : sequence of float, kg
        Masses of the systems.
    """
    found, places = np.array(momenta, dtype=np.float64), np.array(centers, dtype=np.float64)
    common = np.einsum("k,kti->ti", np.array(masses), places) / sum(masses)
    found[:, :, 3:] += np.cross(places - common, found[:, :, :3])
    return found


def shared_rows(times: Sequence[Floats]) -> list[NDArray[np.int64]]:
    """Return, for each system, the indices of its rows at the times that are common to all systems.

    If all systems have equal times, every row is used; otherwise the last row at each common time is used.
    """
    first = times[0]
    if all(np.array_equal(other, first) for other in times):
        return [np.arange(len(first))] * len(times)
    common = reduce(np.intersect1d, times)
    return [np.searchsorted(own, common, side="right") - 1 for own in times]
