"""Evaluates arithmetic in YAML values, such as ``(60.0*pi)/180.0``: numbers and named functions only."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable
from typing import ClassVar

from onorbit_rs.common.evaluator import Evaluator, parsed
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import QuantityError

_CONSTANTS = {"pi": math.pi}
_FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "tan": math.tan,
    "asin": math.asin, "acos": math.acos, "atan": math.atan,
    "deg": math.radians, "rad": float, "radians": math.radians,
}  # fmt: skip
"""Functions of one number; as in ROS, ``deg(60)`` and ``rad(2*pi)`` return radians."""

_LONGEST = 200


def evaluate(value: object) -> float:
    """Return the value of a number, or of text with arithmetic of numbers, ``pi`` and a few functions.

    >>> evaluate("(60.0*pi)/180.0")
    1.0471975511965976

    Raises
    ------
    QuantityError
        If the value is neither a number nor such text, or the result is not a finite number.
    """
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return _finite(value, float(value) if abs(value) < 1e308 else math.inf)
    if not isinstance(value, str):
        raise _refused(value, "is not a number")
    try:
        return _finite(value, _Arithmetic(value).visit(parsed(value.strip(), _LONGEST)))
    except (SyntaxError, ValueError, ZeroDivisionError, OverflowError, RecursionError) as error:
        if isinstance(error, QuantityError):
            raise
        reason = error.msg if isinstance(error, SyntaxError) else str(error)
        short = value if len(value) <= _LONGEST else f"{value[:40]}..."
        raise _refused(short, f"cannot be computed ({reason})") from None


class _Arithmetic(Evaluator):
    """Evaluates arithmetic with floats only, so that the size of powers is bounded."""

    unary: ClassVar = {ast.UAdd: operator.pos, ast.USub: operator.neg}
    binary: ClassVar = {
        ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
        ast.Pow: math.pow,
    }  # fmt: skip

    def __init__(self, text: object) -> None:
        self._text = text

    def visit(self, node: ast.AST) -> float:
        return float(super().visit(node))

    def visit_Name(self, node: ast.Name) -> float:
        if node.id not in _CONSTANTS:
            raise self._unknown(node.id)
        return _CONSTANTS[node.id]

    def visit_Call(self, node: ast.Call) -> float:
        match node:
            case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in _FUNCTIONS:
                return _FUNCTIONS[name](self.visit(argument))
            case ast.Call(func=ast.Name(id=name)) if name not in _FUNCTIONS:
                raise self._unknown(name)
        raise self.refused(node)

    def refused(self, node: ast.AST) -> QuantityError:
        return _refused(
            self._text,
            "is not an arithmetic expression of numbers, pi and functions of one number such as sqrt",
        )

    def _unknown(self, name: str) -> QuantityError:
        return _refused(
            self._text, f"contains the unknown name {name!r}{did_you_mean(name, [*_CONSTANTS, *_FUNCTIONS])}"
        )


def _finite(text: object, number: float) -> float:
    if not math.isfinite(number):
        raise _refused(text, "is not a finite number")
    return number


def _refused(text: object, why: str) -> QuantityError:
    fix = "" if "did you mean" in why else "; give a number, or arithmetic such as (60.0*pi)/180.0"
    return QuantityError(f"{text!r} {why}{fix}", text=text, expected="a number or arithmetic")
