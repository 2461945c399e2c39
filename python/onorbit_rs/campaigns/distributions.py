"""Distributions of dispersed values, and the changes of entries of the scenario that use them."""

from __future__ import annotations

import math
from functools import cached_property
from statistics import NormalDist
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, PlainSerializer, PlainValidator, model_validator

from onorbit_rs.common.numbers import shortest
from onorbit_rs.scenario.errors import invalid, shortened
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.units import split_quantity

_STANDARD = NormalDist()
LEAST_PROBABILITY = 1e-9
"""Smallest accepted probability of the interval ``within`` of a normal distribution."""


def _cdf(z: float) -> float:
    """Return the cumulative distribution function of the standard normal distribution at ``z``."""
    return 0.5 * math.erfc(-z / math.sqrt(2.0))


class Amount(float):
    """Number in SI units, with the text from which it was converted.

    ``written`` is the text, and ``unit`` the unit in it, which is empty if there was none.
    """

    unit: str = ""
    written: str = ""


def amount(value: Any) -> Amount:
    """Convert a number, or text with a unit of any dimension, to SI; raise QuantityError for other values."""
    if isinstance(value, Amount):
        return value
    number, unit = split_quantity(value)
    found = Amount(number)
    found.unit, found.written = unit, str(value)
    return found


Quantity = Annotated[Amount, PlainValidator(amount), PlainSerializer(float)]
"""Number in SI units, or text with a unit of any dimension."""

Pair = Annotated[list[Quantity], Field(min_length=2, max_length=2)]


class Distribution(Part):
    """Distribution of one value: exactly one of ``uniform``, ``normal`` and ``choice``."""

    synonyms: ClassVar = {
        "gaussian": "normal", "gauss": "normal", "range": "uniform", "choices": "choice", "values": "choice",
        "bounds": "within", "truncated": "within", "clip": "within",
    }  # fmt: skip

    uniform: Pair | None = None
    """Least and largest value."""
    normal: Pair | None = None
    """Mean and standard deviation."""
    within: Pair | None = None
    """Least and largest value of ``normal``: the distribution is truncated, not clipped."""
    choice: Annotated[list[Any], Field(min_length=1)] | None = None
    """Values of equal probability: numbers, texts, lists or mappings."""

    @model_validator(mode="before")
    @classmethod
    def _is_mapping(cls, value: Any) -> Any:
        if not isinstance(value, dict) and not isinstance(value, Part):
            raise invalid(
                "must be a distribution {uniform: [a, b]}, {normal: [mean, standard deviation]} or "
                f"{{choice: [...]}}, not {shortened(value)}"
            )
        return value

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        given = [name for name in ("uniform", "normal", "choice") if getattr(self, name) is not None]
        if len(given) != 1:
            listed = ", ".join(given) or "none"
            raise invalid(f"give exactly one of 'uniform', 'normal' and 'choice'; given: {listed}")
        if self.within is not None and self.normal is None:
            raise invalid("'within' applies only to 'normal'; omit it")
        for name in ("uniform", "within"):
            pair = getattr(self, name)
            if pair is not None and not pair[0] < pair[1]:
                shown = ", ".join(bound.written for bound in pair)
                raise invalid(
                    f"the bounds of '{name}' are [{shown}]; the first must be smaller than the second"
                )
        if self.normal is not None and self.normal[1] <= 0.0:
            raise invalid(f"the standard deviation is {self.normal[1].written}; it must be above zero")
        if self.within is not None and self._probability < LEAST_PROBABILITY:
            raise invalid(
                f"the probability of the interval 'within' is {shortest(self._probability)}; it must be at "
                f"least {LEAST_PROBABILITY:g}; give a wider interval, or one nearer to the mean"
            )
        return self

    @cached_property
    def _standard_bounds(self) -> tuple[float, float, bool]:
        """Cumulative probabilities of the bounds of ``within``, and whether the bounds are mirrored.

        Bounds above the mean are mirrored about it, because probabilities close to one are inaccurate.
        """
        assert self.normal is not None
        assert self.within is not None
        mean, sigma = self.normal
        low, high = ((bound - mean) / sigma for bound in self.within)
        is_inverted = low > 0.0
        if is_inverted:
            low, high = -high, -low
        return _cdf(low), _cdf(high), is_inverted

    @property
    def _probability(self) -> float:
        low, high, _ = self._standard_bounds
        return high - low

    @property
    def amounts(self) -> list[Amount]:
        """The numbers that define the distribution, except the values of ``choice``."""
        return [*(self.uniform or ()), *(self.normal or ()), *(self.within or ())]

    @property
    def bounds(self) -> Pair | None:
        """Least and largest value of ``uniform`` or ``within``; None if neither is given."""
        return self.uniform or self.within

    def value(self, u: float) -> float:
        """Return the number, in SI units, whose cumulative probability is ``u``.

        It is `x = a + u (b − a)` for a uniform distribution and `x = µ + σ Φ⁻¹(u)` for a normal one. If
        ``within`` has the bounds `a` and `b`, `u` is first mapped to `Φ(α) + u [Φ(β) − Φ(α)]`, where
        `α = (a − µ)/σ` and `β = (b − µ)/σ`. The values of ``choice`` must be numbers.
        """
        if self.choice is not None:
            return float(self.pick(u))
        if self.uniform is not None:
            first, last = map(float, self.uniform)
            return min(first + u * (last - first), last)
        assert self.normal is not None
        mean, sigma = map(float, self.normal)
        if self.within is None:
            return mean + sigma * _STANDARD.inv_cdf(u)
        low, high, is_inverted = self._standard_bounds
        p = low + (1.0 - u if is_inverted else u) * (high - low)
        z = _STANDARD.inv_cdf(min(max(p, 5e-324), 1.0 - 2.0**-53))
        drawn = mean + sigma * (-z if is_inverted else z)
        return min(max(drawn, float(self.within[0])), float(self.within[1]))

    def pick(self, u: float) -> Any:
        """Return the value of ``choice`` that a random number ``u`` in (0, 1) selects."""
        assert self.choice is not None
        return self.choice[min(int(u * len(self.choice)), len(self.choice) - 1)]


class Change(Part):
    """Change of an entry of the scenario: exactly one of ``set``, ``add`` and ``scale``."""

    synonyms: ClassVar = {"multiply": "scale", "factor": "scale", "offset": "add", "value": "set"}

    set: Distribution | None = None
    """Distribution of the value that replaces the nominal one."""
    add: Distribution | None = None
    """Distribution of the number that is added to the nominal value."""
    scale: Distribution | None = None
    """Distribution of the factor by which the nominal value is multiplied."""
    vector: Literal["components", "direction"] = "components"
    """How a vector is drawn: ``components`` draws each component independently, in the axes of the entry.
    ``direction`` draws a magnitude and a uniformly distributed direction for ``set`` and ``add``, and one
    factor for the whole vector for ``scale``."""

    @model_validator(mode="before")
    @classmethod
    def _is_mapping(cls, value: Any) -> Any:
        if not isinstance(value, dict) and not isinstance(value, Part):
            raise invalid(
                "must be a mapping with 'set', 'add' or 'scale', such as {add: {normal: [0, 0.1]}}, not "
                f"{shortened(value)}"
            )
        return value

    @classmethod
    def _hint(cls, key: str, free: list[str]) -> str:
        if key in ("uniform", "normal", "choice"):
            return f"; it belongs in 'set', 'add' or 'scale', such as {{add: {{{key}: [...]}}}}"
        return super()._hint(key, free)

    @model_validator(mode="after")
    def _is_one(self) -> Self:
        given = [name for name in ("set", "add", "scale") if getattr(self, name) is not None]
        if len(given) != 1:
            raise invalid(
                f"give exactly one of 'set', 'add' and 'scale'; given: {', '.join(given) or 'none'}"
            )
        return self

    @property
    def how(self) -> Literal["set", "add", "scale"]:
        """Kind of the change: ``set``, ``add`` or ``scale``."""
        return "set" if self.set is not None else "add" if self.add is not None else "scale"

    @property
    def distribution(self) -> Distribution:
        """Distribution of the change."""
        found = self.set or self.add or self.scale
        assert found is not None
        return found
