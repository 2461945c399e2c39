"""Evaluates expressions in files from their syntax tree; nothing is compiled or executed."""

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
        If the text has more than ``longest`` characters or is nested too deeply.
    SyntaxError
        If the text is not a Python expression.
    """
    if len(text) > longest:
        raise ValueError(f"the expression has {len(text)} characters; at most {longest} are allowed")
    try:
        return ast.parse(text, mode="eval").body
    except (MemoryError, RecursionError):
        raise ValueError("the expression is nested too deeply; divide it into several expressions") from None


class Evaluator(ast.NodeVisitor, ABC):
    """Evaluates numbers and operators, and raises an error for nodes without a ``visit_`` method.

    A subclass adds a method for each further kind of node that its files may contain.
    """

    constants: ClassVar[tuple[type, ...]] = (int, float)
    """Types of the literals that an expression may contain."""
    unary: ClassVar[Mapping[type[ast.unaryop], Callable[[Any], Any]]] = {}
    binary: ClassVar[Mapping[type[ast.operator], Callable[[Any, Any], Any]]] = {}

    def generic_visit(self, node: ast.AST) -> Any:
        """Raise the error of :meth:`refused` for a kind of node that is not allowed."""
        raise self.refused(node)

    def visit_Constant(self, node: ast.Constant) -> Any:
        """Return the value of a literal; True and False are rejected unless bool is one of the types."""
        if type(node.value) not in self.constants:
            raise self.refused(node)
        return node.value

    def visit_UnaryOp(self, node: ast.UnaryOp) -> Any:
        """Return the value of a unary operation, such as ``-a``."""
        return self._rule(self.unary, node.op)(self.visit(node.operand))

    def visit_BinOp(self, node: ast.BinOp) -> Any:
        """Return the value of a binary operation, such as ``a + b``."""
        return self._rule(self.binary, node.op)(self.visit(node.left), self.visit(node.right))

    @abstractmethod
    def refused(self, node: ast.AST) -> Exception:
        """Return the error for a node that is not allowed in an expression."""

    def _rule(self, rules: Mapping[type[Any], Callable[..., Any]], sign: ast.AST) -> Callable[..., Any]:
        if type(sign) not in rules:
            raise self.refused(sign)
        return rules[type(sign)]
