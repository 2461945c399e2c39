"""Arithmetic in the values of a YAML: ``(60.0*pi)/180.0``. Numbers and named functions, nothing else runs."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable
from typing import Any

from onorbit_rs.exceptions import QuantityError
from onorbit_rs.names import did_you_mean

_CONSTANTS = {"pi": math.pi}
_FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "tan": math.tan,
    "asin": math.asin, "acos": math.acos, "atan": math.atan,
    "deg": math.radians, "rad": float, "radians": math.radians,
}  # fmt: skip
"""``deg(60)`` and ``rad(2*pi)`` are ROS': both give radians."""

_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Pow: math.pow,
}  # fmt: skip
_UNARY: dict[type[ast.unaryop], Callable[[Any], Any]] = {ast.UAdd: operator.pos, ast.USub: operator.neg}

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
    if len(value) > _LONGEST:
        raise _refused(value[:40] + "...", f"is longer than {_LONGEST} characters")
    try:
        return _finite(value, _value(ast.parse(value.strip(), mode="eval").body, value))
    except (SyntaxError, ValueError, ZeroDivisionError, OverflowError, RecursionError, MemoryError) as error:
        if isinstance(error, QuantityError):
            raise
        reason = error.msg if isinstance(error, SyntaxError) else str(error)
        raise _refused(value, f"cannot be computed ({reason})") from None


def _value(node: ast.expr, text: str) -> float:
    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            return float(number)
        case ast.Name(id=name) if name in _CONSTANTS:
            return _CONSTANTS[name]
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            return float(_BINARY[type(op)](_value(left, text), _value(right, text)))
        case ast.UnaryOp(op=op, operand=operand) if type(op) in _UNARY:
            return float(_UNARY[type(op)](_value(operand, text)))
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](_value(argument, text))
        case ast.Name(id=name) | ast.Call(func=ast.Name(id=name)):
            raise _refused(text, f"names {name!r}{did_you_mean(name, [*_CONSTANTS, *_FUNCTIONS])}")
        case _:
            raise _refused(text, "is no arithmetic of numbers, pi and functions like sqrt")


def _finite(text: object, number: float) -> float:
    if not math.isfinite(number):
        raise _refused(text, "is no finite number")
    return number


def _refused(text: object, why: str) -> QuantityError:
    return QuantityError(f"{text!r} {why}", text=text, expected="a number or arithmetic")
