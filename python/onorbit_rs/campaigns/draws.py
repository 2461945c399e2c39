"""Random numbers of a campaign, which do not depend on the order in which the cases run."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from onorbit_rs.exceptions import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

Sampling = Literal["random", "latin_hypercube", "sobol"]

_BITS = 52
_LAST = 1.0 - 2.0**-53
"""Largest number below 1."""


def unit_random(seed: int, case: int, path: str) -> float:
    """Return a uniformly distributed number in (0, 1): 52 bits of the BLAKE2b hash of ``seed/case/path``."""
    digest = hashlib.blake2b(f"{seed}/{case}/{path}".encode(), digest_size=8).digest()
    return float(((int.from_bytes(digest, "little") >> (64 - _BITS)) + 0.5) * 2.0**-_BITS)


def unit_draw(sampling: Sampling, seed: int, cases: int, case: int, path: str, dimension: int) -> float:
    """Return the random number in (0, 1) from which a case computes one dispersed value.

    Parameters
    ----------
    sampling : str
        ``random``: independent numbers. ``latin_hypercube``: each of ``cases`` equal intervals contains the
        number of one case, at a random place; the order of the intervals is random. ``sobol``: coordinate
        ``dimension`` of the Sobol sequence, with a random digital shift.
    seed : int
        Seed of the campaign.
    cases : int
        Number of cases.
    case : int
        Number of the case, from 0.
    path : str
        Name of the random number.
    dimension : int
        Index of the random number among those of a case, from 0; used by ``sobol`` only.

    Returns
    -------
    float
    """
    if sampling == "random":
        return unit_random(seed, case, path)
    if sampling == "latin_hypercube":
        inside = unit_random(seed, case, f"{path}/interval")
        return min(float((int(_order(seed, cases, path)[case]) + inside) / cases), _LAST)
    bits = int(_sobol(cases, dimension + 1)[case, dimension]) ^ _shift(seed, path)
    return min((bits + unit_random(seed, case, f"{path}/cell")) * 2.0**-_SOBOL_BITS, _LAST)


@lru_cache(maxsize=512)
def _order(seed: int, cases: int, path: str) -> NDArray[np.intp]:
    """Return a random permutation of the cases: the order of Philox numbers keyed by seed and path."""
    key = int.from_bytes(hashlib.blake2b(f"{seed}/order/{path}".encode(), digest_size=16).digest(), "little")
    return np.argsort(np.random.Philox(key=key).random_raw(cases), kind="stable")


_SOBOL_BITS = 32


def _shift(seed: int, path: str) -> int:
    """Return the random digital shift, 32 bits, of one coordinate of the Sobol sequence."""
    digest = hashlib.blake2b(f"{seed}/shift/{path}".encode(), digest_size=4).digest()
    return int.from_bytes(digest, "little")


_tables: dict[int, NDArray[np.uint32]] = {}


def _sobol(cases: int, dimensions: int) -> NDArray[np.uint32]:
    """Return the first points of the unscrambled Sobol sequence times 2³², (cases, n), n >= dimensions."""
    table = _tables.get(cases)
    if table is None or table.shape[1] < dimensions:
        table = _tables[cases] = _sobol_points(
            cases, max(dimensions, 32 if table is None else 2 * dimensions)
        )
    return table


def _sobol_points(cases: int, dimensions: int) -> NDArray[np.uint32]:
    qmc = _qmc()
    dimensions = min(dimensions, qmc.Sobol.MAXDIM)
    sequence = qmc.Sobol(dimensions, scramble=False, bits=_SOBOL_BITS)
    points = sequence.random_base2((cases - 1).bit_length())[
        :cases
    ]  # SciPy warns unless the number of points is a power of two
    table: NDArray[np.uint32] = (points * 2.0**_SOBOL_BITS).astype(np.uint32)
    return table


def check_sampling(sampling: Sampling, dimensions: int) -> None:
    """Raise InputError if ``sobol`` is requested, but SciPy is missing or supports fewer dimensions."""
    if sampling == "sobol" and dimensions > (most := int(_qmc().Sobol.MAXDIM)):
        raise InputError(
            f"a case has {dimensions} random numbers, but Sobol sequences have at most {most} dimensions; "
            "disperse fewer values, or use latin_hypercube",
            name="sampling", got=dimensions, expected=f"<= {most}",
        )  # fmt: skip


def _qmc() -> Any:
    """Return SciPy's module of quasi-random sequences; raise InputError if SciPy is not installed."""
    try:
        from scipy.stats import qmc
    except ImportError:
        raise InputError(
            "sampling 'sobol' requires SciPy; install it with: pip install 'onorbit-rs[campaign]'",
            name="sampling", got="sobol",
        ) from None  # fmt: skip
    return qmc
