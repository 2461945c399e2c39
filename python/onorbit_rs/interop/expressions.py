"""Arithmetic in the values of a YAML: ``(60.0*pi)/180.0``. Numbers and named functions, nothing else runs."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable
from typing import ClassVar

from onorbit_rs.exceptions import QuantityError
from onorbit_rs.expressions import Evaluator, parsed
from onorbit_rs.names import did_you_mean

_CONSTANTS = {"pi": math.pi}
_FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "tan": math.tan,
    "asin": math.asin, "acos": math.acos, "atan": math.atan,
    "deg": math.radians, "rad": float, "radians": math.radians,
}  # fmt: skip
"""``deg(60)`` and ``rad(2*pi)`` are ROS': both give radians."""

_LONGEST = 200


def evaluate(value: object) -> float:
    """A number, or text with arithmetic of numbers, ``pi`` and a few functions.

    >>> evaluate("(60.0*pi)/180.0")
    1.0471975511965976

    Raises
    ------
    QuantityError
        Anything else, or a result that is no finite number.
    """
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return _finite(value, float(value) if abs(value) < 1e308 else math.inf)
    if not isinstance(value, str):
        raise _refused(value, "is no number")
    try:
        return _finite(value, _Arithmetic(value).visit(parsed(value.strip(), _LONGEST)))
    except (SyntaxError, ValueError, ZeroDivisionError, OverflowError, RecursionError) as error:
        if isinstance(error, QuantityError):
            raise
        reason = error.msg if isinstance(error, SyntaxError) else str(error)
        short = value if len(value) <= _LONGEST else f"{value[:40]}..."
        raise _refused(short, f"cannot be computed ({reason})") from None


class _Arithmetic(Evaluator):
    """Numbers as floats alone, so that no power grows without end."""

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
        return _refused(self._text, "is no arithmetic of numbers, pi and functions of one number like sqrt")

    def _unknown(self, name: str) -> QuantityError:
        return _refused(self._text, f"names {name!r}{did_you_mean(name, [*_CONSTANTS, *_FUNCTIONS])}")


def _finite(text: object, number: float) -> float:
    if not math.isfinite(number):
        raise _refused(text, "is no finite number")
    return number


def _refused(text: object, why: str) -> QuantityError:
    return QuantityError(f"{text!r} {why}", text=text, expected="a number or arithmetic")
