"""Evaluates the expressions in a xacro file from their syntax tree.

Nothing is compiled or executed. Expressions may contain numbers, text, booleans, lists and mappings, with
arithmetic, comparisons, ``a if b else c``, indexing, and calls of the functions in
:mod:`onorbit_rs.robots.functions`. Attributes of objects, lambdas, comprehensions and assignments are
rejected; the sizes of values and the work for a whole file are limited.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from onorbit_rs.common.evaluator import Evaluator, parsed
from onorbit_rs.robots.functions import (
    MAPPED,
    METHODS,
    Work,
    check_size,
    remainder_or_text,
    repeated,
    safe_power,
    safe_shift,
)

_LONGEST = 4096
"""Largest number of characters of an expression; expressions of real robots have a few hundred."""

_COMPARE: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda item, items: item in items,
    ast.NotIn: lambda item, items: item not in items,
}


def evaluate(text: str, names: Callable[[str], Any], functions: Mapping[str, Any], work: Work) -> Any:
    """Return the value of an expression.

    Parameters
    ----------
    text : str
        The expression between ``${`` and ``}``.
    names : callable
        Returns the value of a property, or, for a namespace, a function that returns its properties; raises
        KeyError for an undefined name.
    functions : mapping
        Functions and constants by name, such as ``sqrt`` and ``math.sqrt``.
    work : Work
        Number of steps that remain for the expansion of the file.

    Raises
    ------
    ValueError
        If the expression is too long, cannot be parsed or contains an element that is not allowed, if its
        value is too large, or if no steps remain.
    NameError, TypeError, ArithmeticError, LookupError
        As Python raises them for the same operations.
    """
    text = text.strip()
    try:
        tree = parsed(text, _LONGEST)
    except SyntaxError as error:
        raise ValueError(f"{text!r} is not a valid expression ({error.msg})") from None
    return _Evaluation(names, functions, work).visit(tree)


class _Evaluation(Evaluator):
    """Evaluates the syntax tree of one xacro expression."""

    constants: ClassVar = (int, float, str, bool, type(None))
    binary: ClassVar = {
        ast.Add: operator.add,
        ast.Sub: operator.sub,
        ast.Mult: repeated,
        ast.Div: operator.truediv,
        ast.FloorDiv: operator.floordiv,
        ast.Mod: remainder_or_text,
        ast.Pow: safe_power,
        ast.LShift: safe_shift,
        ast.RShift: operator.rshift,
        ast.BitAnd: operator.and_,
        ast.BitOr: operator.or_,
        ast.BitXor: operator.xor,
    }
    unary: ClassVar = {
        ast.UAdd: operator.pos,
        ast.USub: operator.neg,
        ast.Not: operator.not_,
        ast.Invert: operator.invert,
    }

    def __init__(self, names: Callable[[str], Any], functions: Mapping[str, Any], work: Work) -> None:
        self._names, self._functions, self._work = names, functions, work

    def visit(self, node: ast.AST) -> Any:
        """Return the value of a node: plain data of limited size."""
        self._work.spend(1)
        value = super().visit(node)
        check_size(value, self._work)
        return value

    def visit_Name(self, node: ast.Name) -> Any:
        try:
            found = self._names(node.id)
        except KeyError:
            return self._constant_of(node.id)
        if callable(found):
            raise NameError(f"{node.id!r} is a namespace; write {node.id}.NAME")
        return found

    def _constant_of(self, name: str) -> Any:
        found = self._functions.get(name)
        if found is None or callable(found):
            raise NameError(
                f"name {name!r} is not defined; define {name.partition('.')[0]!r} as a property, or as an "
                "argument for $(eval ...), or correct the name"
                if found is None
                else f"{name!r} is a function; call it, as {name}(...)"
            )
        return found

    def visit_BoolOp(self, node: ast.BoolOp) -> Any:
        value: Any = None
        for part in node.values:
            value = self.visit(part)
            if bool(value) is isinstance(node.op, ast.Or):
                return value
        return value

    def visit_Compare(self, node: ast.Compare) -> Any:
        left = self.visit(node.left)
        for sign, part in zip(node.ops, node.comparators, strict=True):
            right = self.visit(part)
            if not _COMPARE[type(sign)](left, right):
                return False
            left = right
        return True

    def visit_IfExp(self, node: ast.IfExp) -> Any:
        return self.visit(node.body if self.visit(node.test) else node.orelse)

    def visit_List(self, node: ast.List) -> Any:
        return [self.visit(item) for item in node.elts]

    def visit_Tuple(self, node: ast.Tuple) -> Any:
        return tuple(self.visit(item) for item in node.elts)

    def visit_Dict(self, node: ast.Dict) -> Any:
        if any(key is None for key in node.keys):
            raise self.refused(node)
        pairs = zip(node.keys, node.values, strict=True)
        return {self.visit(key): self.visit(value) for key, value in pairs if key is not None}

    def visit_Subscript(self, node: ast.Subscript) -> Any:
        return self.visit(node.value)[self._index(node.slice)]

    def _index(self, node: ast.expr) -> Any:
        if not isinstance(node, ast.Slice):
            return self.visit(node)
        ends = (node.lower, node.upper, node.step)
        return slice(*(None if end is None else self.visit(end) for end in ends))

    def visit_Attribute(self, node: ast.Attribute) -> Any:
        """Return ``mapping.key``, ``namespace.property`` or ``math.pi``; reject attributes of objects."""
        if node.attr.startswith("_"):
            raise self.refused(node)
        dotted = self._dotted(node)
        if dotted is not None:
            return self._constant_of(dotted)
        scope = self._scope(node.value)
        if scope is not None:
            return scope(node.attr)
        owner = self.visit(node.value)
        if not isinstance(owner, dict):
            raise self.refused(node)
        return owner[node.attr]

    def _dotted(self, node: ast.Attribute) -> str | None:
        """Return a dotted name, such as ``math.sqrt``; None if ``math`` is an expression or a property."""
        if not isinstance(node.value, ast.Name):
            return None
        try:
            self._names(node.value.id)
        except KeyError:
            return f"{node.value.id}.{node.attr}"
        return None

    def _scope(self, node: ast.expr) -> Callable[[str], Any] | None:
        """Return the function that reads a namespace's properties; None if the node is not a namespace."""
        outer = self._names if isinstance(node, ast.Name) else None
        if isinstance(node, ast.Attribute):
            outer = self._scope(node.value)
        if outer is None:
            return None
        found = outer(node.id if isinstance(node, ast.Name) else getattr(node, "attr", ""))
        return found if callable(found) else None

    def visit_Call(self, node: ast.Call) -> Any:
        function = self._function(node.func)
        if any(keyword.arg is None for keyword in node.keywords):
            raise self.refused(node)
        arguments = [self._argument(function, item) for item in node.args]
        keywords = {keyword.arg: self.visit(keyword.value) for keyword in node.keywords if keyword.arg}
        return function(*arguments, **keywords)

    def _argument(self, function: Any, node: ast.expr) -> Any:
        is_mapped = (
            function is self._functions.get("map") and isinstance(node, ast.Name) and node.id in MAPPED
        )
        return self._functions[node.id] if is_mapped and isinstance(node, ast.Name) else self.visit(node)

    def _function(self, node: ast.expr) -> Any:
        name = node.id if isinstance(node, ast.Name) else None
        if isinstance(node, ast.Attribute):
            name = self._dotted(node)
        if name is not None:
            function = self._functions.get(name)
            if not callable(function):
                raise NameError(
                    f"function {name!r} is not available in xacro expressions; use arithmetic, or an "
                    "available function, such as sqrt, sin, atan2, radians, min or max"
                )
            return function
        if not isinstance(node, ast.Attribute):
            raise self.refused(node)
        owner = self.visit(node.value)
        method = METHODS.get(
            (str if isinstance(owner, str) else dict if isinstance(owner, dict) else list, node.attr)
        )
        if method is None:
            raise self.refused(node)
        return lambda *arguments: method(owner, *arguments)

    def refused(self, node: ast.AST) -> ValueError:
        what = ast.unparse(node) if isinstance(node, ast.expr) else type(node).__name__
        return ValueError(
            f"{what!r} is not allowed in a xacro expression; use only numbers, text, lists, mappings, "
            "arithmetic, comparisons, conditions, indexing and the functions of xacro"
        )
