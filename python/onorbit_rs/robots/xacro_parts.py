"""Replaces the parts of PyPI's xacro that evaluate expressions, open files or read the environment."""

from __future__ import annotations

import contextlib
import importlib
import re
import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import yaml

from onorbit_rs.robots.expressions import evaluate
from onorbit_rs.robots.functions import FUNCTIONS, Work
from onorbit_rs.robots.nesting import Nesting, check_depth
from onorbit_rs.robots.wording import wording
from onorbit_rs.robots.xacro_files import Environment, Files

_EXTRAS = re.compile(r"gazebo|ignition|(^|[_./])gz|ros2?_?control|transmission|plugin|sensor|isaac", re.I)
"""Pattern of the names of files and macros that only simulators need."""

_UNITS = {
    "!radians": 1.0,
    "!degrees": 0.017453292519943295,
    "!meters": 1.0,
    "!millimeters": 0.001,
    "!foot": 0.3048,
    "!inches": 0.0254,
}
"""Factors from the unit of a tagged number in a YAML file to rad or m, as in xacro."""


def replace_parts(
    xacro: Any,
    undo: contextlib.ExitStack,
    files: Files,
    work: Work,
    environment: Environment,
    remarks: list[str],
) -> None:
    """Replace, until ``undo`` closes, the parts of xacro that evaluate text or read files or the environment.

    A version of xacro that lacks one of the replaced functions raises AttributeError, because that version
    would evaluate expressions in another function. ``eval`` and ``exec`` are hidden from xacro.
    """
    substitution = importlib.import_module("xacro.substitution_args")
    functions = FUNCTIONS | _file_functions(xacro, files, work)
    include, call = _without_extras(xacro, files, remarks)
    evaluate_all, parse, sizes, nesting = xacro.eval_all, xacro.parse, _Sizes(), Nesting()

    def safe_eval(text: str, symbols: Any, _: Any = None) -> Any:
        return evaluate(text, partial(_property, xacro.Table, symbols), functions, work)

    def eval_argument(text: str, context: Any) -> str:
        def named(name: str) -> Any:
            return substitution.convert_value(context["arg"][name], "auto")

        more = {"arg": named, "env": environment.required, "optenv": environment.optional, "find": files.find}
        return str(evaluate(text, named, functions | more, work))

    def counted_eval_all(node: Any, *others: Any) -> None:
        work.spend(25)
        with nesting.element():
            evaluate_all(node, *others)

    def counted_call(node: Any, macros: Any, symbols: Any) -> Any:
        with contextlib.suppress(KeyError):  # not a macro
            _, _, macro = xacro.resolve_macro(node.tagName.removeprefix("xacro:"), macros, symbols)
            work.spend(5 * sizes.of(macro.body))  # the macro call copies its body
        if not node.tagName.startswith("xacro:"):
            return call(node, macros, symbols)
        with nesting.macro(node.tagName.removeprefix("xacro:")):
            return call(node, macros, symbols)

    def counted_include(node: Any, *others: Any) -> None:
        with nesting.include(node.getAttribute("filename")):
            include(node, *others)

    def checked_parse(source: Any, filename: Any = None) -> Any:
        document = parse(source, filename)
        check_depth(document)
        return document

    def folder_of(_: object) -> str:
        return str(Path(xacro.filestack[-1] or ".").absolute().parent)

    def refused(*_: Any) -> None:
        raise ValueError(
            "the installed version of xacro is not supported, because it would execute Python code from the "
            "file; install xacro 2.1"
        )

    for owner, name, replacement in (
        (xacro, "safe_eval", safe_eval),
        (xacro, "eval_all", counted_eval_all),
        (xacro, "process_include", counted_include),
        (xacro, "parse", checked_parse),
        (xacro, "handle_macro_call", counted_call),
        (substitution, "_eval", eval_argument),
        (substitution, "_eval_find", files.find),
        (substitution, "_eval_env", environment.required),
        (substitution, "_eval_optenv", environment.optional),
        (substitution, "_eval_dirname", folder_of),
    ):
        undo.callback(setattr, owner, name, getattr(owner, name))
        setattr(owner, name, replacement)
    for owner in (xacro, substitution):
        for name, substitute in (("open", files.open), ("eval", refused), ("exec", refused)):
            setattr(owner, name, substitute)
            undo.callback(delattr, owner, name)
    undo.callback(setattr, xacro, "glob", xacro.glob)
    xacro.glob = files


class _Sizes:
    """Cache of the numbers of nodes in macro bodies."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[Any, int]] = {}

    def of(self, body: Any) -> int:
        if id(body) not in self._known:
            waiting, size = [body], 0
            while waiting:
                size += 1
                waiting.extend(waiting.pop().childNodes)
            self._known[id(body)] = (body, size)  # stores the body, so that Python does not reuse its id
        return self._known[id(body)][1]


def _property(table_type: Any, symbols: Any, name: str) -> Any:
    """Return a property of the file or, for a namespace, a function that returns its properties.

    Raises KeyError if the name is not defined. Symbols that xacro itself defines, among them Python's
    functions, are not accessible.
    """
    table = symbols
    while isinstance(table, table_type):
        if dict.__contains__(table, name):
            found = table[name]
            return partial(_property, table_type, found) if isinstance(found, table_type) else found
        table = table.parent
    raise KeyError(name)


def _file_functions(xacro: Any, files: Files, work: Work) -> dict[str, Any]:
    """Return the functions of xacro that depend on the file that calls them."""

    def fatal(*words: Any) -> None:
        raise ValueError(" ".join(map(str, words)))

    def warning(*words: Any) -> str:
        sys.stderr.write(f"warning: {' '.join(map(str, words))}\n")  # collected by expand
        return ""

    def load_yaml(name: str) -> Any:
        path = xacro.abs_filename_spec(name)
        try:
            text = files.open(path).read()
        except OSError:
            raise ValueError(f"cannot load {_missing(name, path, files, {})}") from None
        work.spend(10 * len(text))
        return xacro.YamlListWrapper.wrap(yaml.load(text, Loader=_loader(work)))

    def arg(name: str) -> Any:
        return xacro.substitution_args_context["arg"][name]

    own: dict[str, Any] = {
        "load_yaml": load_yaml, "abs_filename": xacro.abs_filename_spec, "dotify": xacro.YamlDictWrapper,
        "fatal": fatal, "error": warning, "warning": warning, "message": lambda *_: "", "arg": arg,
        "print_location": lambda: "",
    }  # fmt: skip
    bare = ("load_yaml", "abs_filename", "dotify")
    return {f"xacro.{name}": made for name, made in own.items()} | {name: own[name] for name in bare}


def _loader(work: Work) -> type[yaml.SafeLoader]:
    """Return a loader of plain YAML with xacro's units."""

    class Loader(yaml.SafeLoader):
        """YAML loader; a separate class, so that the units do not apply to other YAML loaders."""

    def of_unit(factor: float, loader: yaml.SafeLoader, node: Any) -> float:
        return float(evaluate(str(loader.construct_scalar(node)), _nothing, FUNCTIONS, work)) * factor

    for tag, factor in _UNITS.items():
        Loader.add_constructor(tag, partial(of_unit, factor))
    return Loader


def _nothing(name: str) -> Any:
    raise KeyError(name)


def _without_extras(
    xacro: Any, files: Files, remarks: list[str]
) -> tuple[Callable[..., None], Callable[..., Any]]:
    """Return xacro's include and macro call, modified to skip missing files and macros for simulators."""
    include, call = xacro.process_include, xacro.handle_macro_call
    left_out: list[str] = []

    def include_if_there(node: Any, *others: Any) -> None:
        stack, known = list(xacro.filestack), len(xacro.all_includes)
        try:
            include(node, *others)
        except (xacro.XacroException, ValueError) as error:
            name, paths = node.getAttribute("filename"), xacro.all_includes[known:]
            given = xacro.substitution_args_context["arg"]
            is_folder = (
                len(paths) == 1 and Path(paths[0]).is_dir()
            )  # an empty argument leaves only the folder
            if not isinstance(getattr(error, "exc", None), OSError) and not (
                is_folder and _empty(name, given)
            ):
                raise
            if not _EXTRAS.search(name):
                path = paths[-1] if paths else ""
                raise ValueError(f"cannot include {_missing(name, path, files, given)}") from error
            xacro.filestack[:] = stack
            _leave_out(node, f"the included file {name!r} does not exist", remarks)
            left_out.append(name)

    def call_if_known(node: Any, *others: Any) -> Any:
        try:
            return call(node, *others)
        except xacro.XacroException as error:
            is_extra = left_out and _EXTRAS.search(node.tagName)
            if not (is_extra and str(error).startswith("unknown macro")):
                raise
            _leave_out(node, f"the macro <{node.tagName}> is not defined", remarks)
            return True

    return include_if_there, call_if_known


def _leave_out(node: Any, why: str, remarks: list[str]) -> None:
    remarks.append(f"{why}; it was skipped, since its name indicates that only simulators need it")
    node.parentNode.removeChild(node)


def _missing(name: str, path: str, files: Files, given: Mapping[str, Any]) -> str:
    """Return the name of a missing file, and why it is missing: an argument, a package, or the file itself.

    ``name`` is the name in the file, ``path`` its expanded path, and ``given`` are the values of arguments.
    """
    if empty := _empty(name, given):
        return f"{name!r}: the argument {empty!r} is empty; give it with {wording().argument(empty)}"
    found = re.search(r"\$\(find\s+([^)\s]+)\s*\)|package:/+([^/]+)", f"{name} {path}")
    package = (found[1] or found[2]) if found else None
    if package and files.find(package).startswith("package:"):
        return (
            f"{name!r}: the package {package!r} was not found; give the folder that contains it with "
            f"{wording().packages}"
        )
    shown = path if path and "$" in name else name
    return f"{shown!r}: the file does not exist; correct its name"


def _empty(name: str, given: Mapping[str, Any]) -> str | None:
    """Return the first xacro argument in a file name whose value is empty; None if there is none."""
    asked = re.findall(r"\$\(arg\s+([^)\s]+)\s*\)", name)
    return next((argument for argument in asked if given.get(argument) == ""), None)
