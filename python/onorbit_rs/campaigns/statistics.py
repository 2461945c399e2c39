"""Statistics of a campaign: success rate with confidence bounds, and rank correlations."""

from __future__ import annotations

import math
from statistics import NormalDist
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

CONFIDENCE = 0.95


class Success(NamedTuple):
    """Numbers of successes and cases, with confidence bounds ``low`` and ``high`` of the success rate."""

    successes: int
    cases: int
    low: float
    high: float

    @property
    def fraction(self) -> float:
        """Fraction of successes."""
        return self.successes / self.cases


def wilson(successes: int, cases: int, confidence: float = CONFIDENCE) -> Success:
    """Return the numbers of successes and cases, with the score interval of the probability of success.

    With the fraction `p`, the number of cases `n` and the quantile `z` of the standard normal distribution,
    the bounds are `[p + z²/2n ± z √(p (1 − p)/n + z²/4n²)] / (1 + z²/n)`.

    Source: Wilson, Probable inference, the law of succession, and statistical inference, JASA 22, 1927.
    """
    z = NormalDist().inv_cdf(0.5 + 0.5 * confidence)
    p, n = successes / cases, cases
    middle = p + z * z / (2.0 * n)
    half = z * math.sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n))
    scale = 1.0 + z * z / n
    low = 0.0 if successes == 0 else (middle - half) / scale
    high = 1.0 if successes == cases else (middle + half) / scale
    return Success(successes, cases, low, high)


def ranks(values: Floats) -> Floats:
    """Return the ranks of values, (n,), from 1; equal values get their mean rank."""
    _, inverse, counts = np.unique(values, return_inverse=True, return_counts=True)
    ends = np.cumsum(counts)
    means: Floats = ends - 0.5 * (counts - 1)
    return means[inverse]


def rank_correlation(x: Floats, y: Floats) -> float | None:
    """Return Spearman's rank correlation of two columns, (n,): the correlation of their ranks.

    Rows with a value that is not finite are ignored. Returns None if one column is constant, or if fewer than
    three rows are left.

    Source: Spearman, The proof and measurement of association between two things, Am. J. Psych. 15, 1904.
    """
    use = np.isfinite(x) & np.isfinite(y)
    if use.sum() < 3:
        return None
    a, b = ranks(x[use]), ranks(y[use])
    a, b = a - a.mean(), b - b.mean()
    scale = math.sqrt(float(a @ a) * float(b @ b))
    return float(a @ b) / scale if scale > 0.0 else None


class Sensitivity(NamedTuple):
    """Rank correlation of a dispersed value and a result."""

    value: str
    result: str
    correlation: float


def significant_correlation(cases: int) -> float:
    """Return the magnitude that the rank correlation of independent columns exceeds in 5 % of campaigns.

    For `n` cases its standard deviation is `1/√(n − 1)`.
    """
    return NormalDist().inv_cdf(0.975) / math.sqrt(max(cases - 1, 1))


def sensitivities(columns: dict[str, Floats], values: list[str], results: list[str]) -> list[Sensitivity]:
    """Return the rank correlation of every dispersed value with every result, the strongest first."""
    found = []
    for result in results:
        for value in values:
            correlation = rank_correlation(columns[value], columns[result])
            if correlation is not None:
                found.append(Sensitivity(value, result, correlation))
    return sorted(found, key=lambda one: -abs(one.correlation))


def numeric(values: list[Any]) -> Floats | None:
    """Return a column as floats, with NaN for missing values; None for text."""
    if any(isinstance(value, str) for value in values):
        return None
    return np.array([math.nan if value is None else float(value) for value in values])
