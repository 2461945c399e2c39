"""Functions for the expressions of xacro files, and limits on the size of values."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable
from typing import Any

from onorbit_rs.common.counting import count

MAX_TEXT = 100_000
"""Largest number of characters in a string."""
MAX_ITEMS = 10_000
"""Largest number of items of a list or mapping, including nested items."""
MAX_BITS = 2048
"""Largest number of bits of an integer; the largest float has 1024."""


class Work:
    """Limit on the number of steps in which a file is expanded; each step takes about 1 µs.

    Large robots need a tenth of the default limit.
    """

    def __init__(self, steps: int = 4_000_000) -> None:
        """Set the number of steps that are allowed."""
        self._steps, self._left = steps, steps

    def spend(self, steps: int) -> None:
        """Subtract steps from the remaining steps; raise ValueError if too few remain."""
        self._left -= steps
        if self._left < 0:
            raise ValueError(
                f"the expansion of the file exceeds the limit of {self._steps} steps; simplify its macros "
                "and expressions"
            )


def check_size(value: Any, work: Work) -> None:
    """Raise ValueError unless a value is plain data of limited size; the check spends steps of ``work``."""
    waiting, items, length = [value], 0, 0
    while waiting:
        item = waiting.pop()
        items += 1
        if isinstance(item, str):
            length += len(item)
            if length > MAX_TEXT:
                raise ValueError(
                    f"a value contains at least {length} characters of text, which exceeds the limit of "
                    f"{MAX_TEXT} characters in xacro expressions"
                )
        elif isinstance(item, int):
            if item.bit_length() > MAX_BITS:
                raise ValueError(
                    f"an integer has {item.bit_length()} bits, which exceeds the limit of {MAX_BITS} bits in "
                    "xacro expressions"
                )
        elif isinstance(item, (list, tuple)):
            waiting.extend(list.__iter__(item) if isinstance(item, list) else item)
        elif isinstance(item, dict):
            waiting.extend(dict.values(item))
            waiting.extend(dict.keys(item))
        elif not (item is None or isinstance(item, float)):
            raise ValueError(
                f"a xacro expression has a value of type {type(item).__name__}; use numbers, booleans, "
                "strings, lists, tuples, mappings or None"
            )
        if items + len(waiting) > MAX_ITEMS:
            raise ValueError(f"a list or mapping exceeds the limit of {MAX_ITEMS} items in xacro expressions")
    work.spend(items + length // 8)


def repeated(a: Any, b: Any) -> Any:
    """Return ``a * b``; raise ValueError if a repeated string or list exceeds its size limit."""
    for items, times in ((a, b), (b, a)):
        if isinstance(items, (str, list, tuple)) and isinstance(times, int):
            limit, one = (MAX_TEXT, "character") if isinstance(items, str) else (MAX_ITEMS, "item")
            what = f"repeating {count(len(items), one, f'{one}s')} {count(times, 'time', 'times')}"
            _check(len(items) * times <= limit, what, f"{limit} {one}s")
    return operator.mul(a, b)


def safe_power(a: Any, b: Any) -> Any:
    """Return ``a ** b``; raise ValueError if the result could be an integer above :data:`MAX_BITS` bits."""
    if isinstance(a, int) and isinstance(b, int) and b > 0:
        _check(a.bit_length() * b <= MAX_BITS or abs(a) <= 1, f"{a} ** {b}", f"{MAX_BITS} bits")
    return operator.pow(a, b)


def safe_shift(a: Any, b: Any) -> Any:
    """Return ``a << b``; raise ValueError for a shift by more than :data:`MAX_BITS` bits."""
    _check(not isinstance(b, int) or b <= MAX_BITS, f"a shift by {b} bits", f"{MAX_BITS} bits")
    return operator.lshift(a, b)


def remainder_or_text(a: Any, b: Any) -> Any:
    """Return ``a % b``: the remainder, or formatted text; raise ValueError for unsafe formats."""
    if isinstance(a, str) and (found := re.search(r"%[^a-zA-Z%]*(\(|\*|\d{3})", a)):
        what = {"(": "a mapping key", "*": "a width or precision of '*'"}
        raise ValueError(
            f"the format {a!r} contains {what.get(found[1], 'a width or precision above 99')}, which is not "
            "allowed in xacro expressions; use a format such as '%.3f'"
        )
    return operator.mod(a, b)


def _range(*ends: int) -> list[int]:
    made = range(*ends)
    _check(len(made) <= MAX_ITEMS, f"a range of {len(made)} numbers", f"{MAX_ITEMS} numbers")
    return list(made)


def _round(value: Any, digits: int | None = None) -> Any:
    _check(digits is None or abs(digits) <= 400, f"rounding to {digits} digits", "400 digits")
    return round(value, digits)


def _sum(values: Any, start: float = 0) -> Any:
    return sum(
        (value + 0 for value in values), start + 0
    )  # + 0 raises an error for operands other than numbers


def _replace(text: str, old: str, new: str) -> str:
    length = len(text) + text.count(old) * len(new)
    _check(length <= MAX_TEXT, f"a text of {length} characters", f"{MAX_TEXT} characters")
    return text.replace(old, new)


def _join(text: str, parts: Any) -> str:
    length = len(text) * len(parts) + sum(map(len, parts))
    _check(length <= MAX_TEXT, f"a text of {length} characters", f"{MAX_TEXT} characters")
    return text.join(parts)


def _tokenize(text: str, separators: str = ",; ", skip_empty: bool = True) -> list[str]:
    parts = re.split(f"[{re.escape(separators)}]", text) if separators else [text]
    return [part for part in parts if part or not skip_empty]


def _factorial(n: int) -> int:
    _check(n <= 170, f"the argument {n} of factorial", 170)
    return math.factorial(n)


def _check(is_bounded: bool, what: str, limit: int | str) -> None:
    if not is_bounded:
        raise ValueError(f"{what} exceeds the limit of {limit} in xacro expressions")


_PYTHON: dict[str, Any] = {
    "list": list, "dict": dict, "tuple": tuple, "len": len, "str": str, "float": float, "int": int,
    "bool": bool,
    "min": min, "max": max, "round": _round, "abs": abs, "all": all, "any": any, "sum": _sum, "range": _range,
    "sorted": sorted, "divmod": divmod, "ord": ord,
    "map": lambda function, *values: list(map(function, *values)),
    "zip": lambda *values: list(zip(*values, strict=False)),
    "enumerate": lambda values, start=0: list(enumerate(values, start)),
    "reversed": lambda values: list(reversed(values)),
}  # fmt: skip

_MATH: dict[str, Any] = {
    name: getattr(math, name)
    for name in (
        "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "ceil", "copysign", "cos", "cosh",
        "degrees", "erf", "exp", "expm1", "fabs", "floor", "fmod", "frexp", "fsum", "gamma", "gcd",
        "hypot", "isclose", "isfinite", "isinf", "isnan", "ldexp", "lgamma", "log", "log10", "log1p",
        "log2", "modf", "pow", "radians", "remainder", "sin", "sinh", "sqrt", "tan", "tanh", "trunc",
        "pi", "e", "tau", "inf", "nan",
    )
} | {"factorial": _factorial}  # fmt: skip

FUNCTIONS: dict[str, Any] = (
    {"xacro.tokenize": _tokenize, "true": True, "false": False}
    | {
        f"{space}.{name}": made
        for space, group in (("math", _MATH), ("python", _PYTHON))
        for name, made in group.items()
    }
    | _MATH
    | _PYTHON
)
"""Functions and constants by their names in PyPI's xacro."""

MAPPED = ("float", "int", "str", "bool", "abs", "len")
"""Names of the functions that ``map`` accepts."""

METHODS: dict[tuple[type, str], Callable[..., Any]] = {
    **{
        (str, name): getattr(str, name)
        for name in (
            "lower",
            "upper",
            "strip",
            "lstrip",
            "rstrip",
            "startswith",
            "endswith",
            "split",
            "rsplit",
            "title",
            "capitalize",
            "find",
            "count",
            "index",
            "isdigit",
            "isalpha",
        )
    },
    (str, "replace"): _replace,
    (str, "join"): _join,
    (list, "index"): lambda items, *given: items.index(*given),
    (list, "count"): lambda items, *given: items.count(*given),
    (dict, "keys"): lambda mapping: list(dict.keys(mapping)),
    (dict, "values"): lambda mapping: list(dict.values(mapping)),
    (dict, "items"): lambda mapping: list(dict.items(mapping)),
    (dict, "get"): lambda mapping, key, default=None: dict.get(mapping, key, default),
}
"""Methods of strings, lists and mappings that are allowed; ``format`` is not, since it reads attributes."""
