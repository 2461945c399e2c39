"""Values of expressions in files, computed from their syntax tree: nothing is compiled or executed."""

from __future__ import annotations

import ast
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar


def parsed(text: str, longest: int) -> ast.expr:
    """Return the syntax tree of one expression.

    Raises
    ------
    ValueError
        It has more than ``longest`` characters or is nested too deep.
    SyntaxError
        It is not an expression of Python.
    """
    if len(text) > longest:
        raise ValueError(f"an expression of {len(text)} characters, {longest} are allowed")
    try:
        return ast.parse(text, mode="eval").body
    except (MemoryError, RecursionError):
        raise ValueError("an expression nested too deep") from None


class Evaluator(ast.NodeVisitor, ABC):
    """Visits a tree of numbers and operators; a node without a ``visit_`` method of its kind is refused.

    A subclass adds what its files may hold besides, each kind by a method.
    """

    constants: ClassVar[tuple[type, ...]] = (int, float)
    """Types of literals."""
    unary: ClassVar[Mapping[type[ast.unaryop], Callable[[Any], Any]]] = {}
    binary: ClassVar[Mapping[type[ast.operator], Callable[[Any, Any], Any]]] = {}

    def generic_visit(self, node: ast.AST) -> Any:
        """Refuse a node."""
        raise self.refused(node)

    def visit_Constant(self, node: ast.Constant) -> Any:
        """Return a literal; bool is not int here."""
        if type(node.value) not in self.constants:
            raise self.refused(node)
        return node.value

    def visit_UnaryOp(self, node: ast.UnaryOp) -> Any:
        """Return ``-a``."""
        return self._rule(self.unary, node.op)(self.visit(node.operand))

    def visit_BinOp(self, node: ast.BinOp) -> Any:
        """Return ``a + b``."""
        return self._rule(self.binary, node.op)(self.visit(node.left), self.visit(node.right))

    @abstractmethod
    def refused(self, node: ast.AST) -> Exception:
        """Return the error of a node that may not stand in an expression."""

    def _rule(self, rules: Mapping[type[Any], Callable[..., Any]], sign: ast.AST) -> Callable[..., Any]:
        if type(sign) not in rules:
            raise self.refused(sign)
        return rules[type(sign)]
