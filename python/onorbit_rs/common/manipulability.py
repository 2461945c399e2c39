"""Manipulability of a tool."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def manipulability(jacobians: Floats) -> Floats:
    """Return Yoshikawa's manipulability `√det(J Jᵀ)`, (...), of Jacobians (..., m, n).

    The manipulability is computed as the product of the singular values, which for m > n is `√det(Jᵀ J)`.

    Source: Yoshikawa, Int. J. Robotics Research 4(2), 1985.
    """
    product: Floats = np.linalg.svd(jacobians, compute_uv=False).prod(axis=-1)
    return product
