"""Inspects the source of a class written in Python without executing it."""

from __future__ import annotations

import ast
import importlib.machinery
import importlib.util
import inspect
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.common.input_files import LARGEST_TEXT, check_regular, read_bytes
from onorbit_rs.exceptions import NotFoundError
from onorbit_rs.scenario.user_code.errors import no_class, no_method, no_module, no_python

if TYPE_CHECKING:
    from onorbit_rs.scenario.user_code.part import UserClass

_BASES_WITHOUT_METHOD = ("Controller", "Effect", "ABC", "object", "Protocol", "Generic")
_KINDS = inspect.Parameter


class Placeholder:
    """Replaces a controller whose source was inspected but not executed; its efforts are zero."""

    def update(self, t: float, state: Any) -> Any:
        """Return zero efforts, (n,), N m or N."""
        return np.zeros(len(state.joints))


def source_of(part: UserClass, folder: Path) -> str:
    """Return the path of the file that defines the class, or the name of a module without a file.

    Parameters
    ----------
    part : UserClass
        Part of the scenario.
    folder : path
        Folder of the scenario, at which a relative path starts.

    Raises
    ------
    NotFoundError, ReadError
        If there is no such file or module, or it is a folder, a pipe or a device.
    """
    if part.file is not None:
        file = folder / part.file
        try:
            check_regular(file, part.role)
        except NotFoundError as error:
            message = f"{error}; a relative path starts at the scenario's folder"
            raise NotFoundError(message, path=str(file), kind=part.role) from None
        return str(file)
    found = _module_file(part)
    return str(part.module) if found is None else found


def inspect_source(part: UserClass, folder: Path) -> Placeholder:
    """Return a placeholder for an object of the user's class after inspecting its source.

    Only properties that are known without executing the source are checked.

    Parameters
    ----------
    part : UserClass
        Part of the scenario.
    folder : path
        Folder of the scenario, at which a relative path starts.

    Raises
    ------
    NotFoundError, ReadError
        If there is no such file or module, or it cannot be read.
    ControlError, EffectError
        If the source is not Python, the class or its method is missing, or its constructor does
        not accept the arguments.
    """
    source = source_of(part, folder)
    if not source.endswith(".py"):
        if part.file is None:
            return Placeholder()  # a compiled module has no source
        raise no_python(part, source)
    try:
        tree = ast.parse(read_bytes(source, LARGEST_TEXT, part.role), filename=source)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        reason = " ".join(str(error).split())
        raise part.error(
            f"{source} cannot be read as Python: {type(error).__name__}: {reason}; correct the file",
            name="file",
            got=source,
        ) from error
    statements = list(_statements(tree))
    bound = Counter(name for statement in statements for name in _bound_names(statement))
    if not bound[part.class_] and not bound["*"]:
        raise no_class(part, source, [node.name for node in statements if isinstance(node, ast.ClassDef)])
    # which definition of several applies, such as in "try" and "except", is not known
    classes = {
        node.name: node for node in statements if isinstance(node, ast.ClassDef) and bound[node.name] == 1
    }
    definition = classes.get(part.class_)
    if definition is not None:
        _check_class(definition, classes, part, source)
    return Placeholder()


def _module_file(part: UserClass) -> str | None:
    """Return the file of a module, or None if it has none, without importing the module or its packages."""
    top, *rest = str(part.module).split(".")
    try:
        spec = importlib.util.find_spec(top)
    except (ValueError, ImportError):
        return None
    for depth in range(len(rest)):
        folders = None if spec is None else spec.submodule_search_locations
        inner = ".".join([top, *rest[: depth + 1]])
        spec = None if folders is None else importlib.machinery.PathFinder.find_spec(inner, folders)
    if spec is None:
        raise no_module(part)
    return spec.origin if spec.has_location else None


def _statements(module: ast.Module) -> Iterator[ast.stmt]:
    """Yield the statements of a module at any depth, except those in functions and classes."""
    waiting: list[ast.AST] = [module]
    while waiting:
        for child in ast.iter_child_nodes(waiting.pop()):
            if isinstance(child, ast.stmt):
                yield child
            if not isinstance(child, (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef, ast.expr)):
                waiting.append(child)


def _bound_names(statement: ast.stmt) -> list[str]:
    """Return the names that a class, an import or an assignment defines; ``*`` stands for any names."""
    if isinstance(statement, ast.ClassDef):
        return [statement.name]
    if isinstance(statement, (ast.Import, ast.ImportFrom)):
        return [alias.asname or alias.name.split(".")[0] for alias in statement.names]
    if not isinstance(statement, (ast.Assign, ast.AnnAssign)):
        return []
    names = [node for node in ast.walk(statement) if isinstance(node, ast.Name)]
    return [node.id for node in names if isinstance(node.ctx, ast.Store)]


def _check_class(
    definition: ast.ClassDef, classes: dict[str, ast.ClassDef], part: UserClass, source: str
) -> None:
    """Raise an error for a class without its method, or a constructor that rejects the arguments."""
    line, are_all_known = _with_bases(definition, classes)
    methods = [
        (node.name, node)
        for one in line
        for node in one.body
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
    ]
    names = {name for name, _ in methods} | {
        node.id for one in line for item in one.body if isinstance(item, ast.Assign)
        for node in ast.walk(item) if isinstance(node, ast.Name)
    }  # fmt: skip
    if part.method_name not in names and are_all_known:
        raise no_method(part, source)
    is_plain = are_all_known and "__new__" not in names and not any(one.decorator_list for one in line)
    constructor = next((node for name, node in methods if name == "__init__"), None)
    if not is_plain or (constructor is not None and constructor.decorator_list):
        return
    parameters = [] if constructor is None else _parameters(constructor.args)
    try:
        inspect.Signature(parameters).bind(**part.arguments)
    except TypeError as error:
        raise part.error(
            f"{part.class_}(...) of {source} does not accept the arguments {part.arguments}: {error}; "
            "correct 'arguments'",
            name="arguments",
            got=part.arguments,
        ) from error


def _with_bases(
    definition: ast.ClassDef, classes: dict[str, ast.ClassDef]
) -> tuple[list[ast.ClassDef], bool]:
    """Return a class with its bases in the same file, and True if no other base can define the method."""
    line, are_all_known, waiting = [], not definition.keywords, [definition]
    while waiting:
        one = waiting.pop(0)
        if one in line:
            continue
        line.append(one)
        for base in one.bases:
            name = (
                base.id
                if isinstance(base, ast.Name)
                else base.attr
                if isinstance(base, ast.Attribute)
                else ""
            )
            if isinstance(base, ast.Name) and name in classes:
                waiting.append(classes[name])
            elif name not in _BASES_WITHOUT_METHOD:
                are_all_known = False
    return line, are_all_known


def _parameters(given: ast.arguments) -> list[inspect.Parameter]:
    """Return the parameters of a constructor without ``self``, in the order that a signature requires."""
    plain = [*given.posonlyargs, *given.args]
    without_default = len(plain) - len(given.defaults)
    parameters = [
        inspect.Parameter(
            argument.arg,
            _KINDS.POSITIONAL_ONLY if i < len(given.posonlyargs) else _KINDS.POSITIONAL_OR_KEYWORD,
            default=_KINDS.empty if i < without_default else None,
        )
        for i, argument in enumerate(plain)
    ][1:]
    if given.vararg:
        parameters.append(inspect.Parameter(given.vararg.arg, _KINDS.VAR_POSITIONAL))
    for argument, default in zip(given.kwonlyargs, given.kw_defaults, strict=True):
        value = _KINDS.empty if default is None else None
        parameters.append(inspect.Parameter(argument.arg, _KINDS.KEYWORD_ONLY, default=value))
    if given.kwarg:
        parameters.append(inspect.Parameter(given.kwarg.arg, _KINDS.VAR_KEYWORD))
    return parameters
