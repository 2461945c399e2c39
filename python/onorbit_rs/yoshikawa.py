"""How well a tool can be moved."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def manipulability(jacobians: Floats) -> Floats:
    """Yoshikawa's measure `√det(J Jᵀ)` of (..., m, n) Jacobians: the product of their singular values.

    Source: Yoshikawa, Int. J. Robotics Research 4(2), 1985.
    """
    product: Floats = np.linalg.svd(jacobians, compute_uv=False).prod(axis=-1)
    return product
