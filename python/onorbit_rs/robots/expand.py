"""From xacro to URDF text, with PyPI's ``xacro`` and without ROS."""

from __future__ import annotations

import contextlib
import importlib
import io
import os
import re
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from onorbit_rs import reading
from onorbit_rs.exceptions import ModelError, NotFoundError, ReadError
from onorbit_rs.names import did_you_mean

_LOCK = threading.Lock()  # xacro keeps its state in globals

_EXTRAS = re.compile(r"gazebo|ignition|(^|[_./])gz|ros2?_?control|transmission|plugin|sensor|isaac", re.I)
"""What names files and macros of simulators, which a robot does without."""


def expand(
    path: str | os.PathLike[str],
    package_paths: Sequence[str | os.PathLike[str]] = (),
    arguments: Mapping[str, object] | None = None,
) -> tuple[str, list[str]]:
    """The URDF that a xacro file stands for, and remarks on what was left out.

    Parameters
    ----------
    path : path
        The file. The expressions in it run, as they do with ROS' own tool.
    package_paths : sequence of paths
        Folders that hold ROS packages or are one: what ``$(find name)`` gives; the file's parents come after.
    arguments : mapping, optional
        What ``$(arg name)`` gives.

    Raises
    ------
    NotFoundError, ReadError
        No such file, or it cannot be read.
    ModelError
        ``xacro`` is not installed (says how), or the file does not expand (says why).
    """
    file = Path(path)
    if not file.exists():
        raise NotFoundError(f"{file}: there is no such file", path=str(file), kind="robot")
    if file.is_dir():
        raise ReadError(f"{file}: this is a folder, not a xacro file", path=str(file), kind="robot")
    reading.check_regular(file, "robot")
    try:
        xacro = importlib.import_module("xacro")
    except ImportError as error:
        raise ModelError(
            f"{file}: this is xacro, which PyPI's xacro expands: pip install 'onorbit-rs[xacro]'",
            path=str(file),
        ) from error
    folders = [Path(folder) for folder in package_paths] + list(file.absolute().parents)
    values = {name: _text(value) for name, value in (arguments or {}).items()}
    remarks: list[str] = []
    used: set[str] = set()
    said = io.StringIO()
    try:
        _check_text(file)
        with _LOCK, _patched(xacro, folders, remarks, used), contextlib.redirect_stderr(said):
            document = xacro.process_file(str(file), mappings=dict(values))
            text = document.documentElement.toxml()
    except RecursionError:
        raise ModelError(f"{file}: macros, includes or elements nested too deep", path=str(file)) from None
    except OSError as error:
        raise ReadError(
            f"cannot read {file}: {error.strerror or error}", path=str(file), kind="robot"
        ) from error
    except Exception as error:  # xacro's own, expat's, and whatever an expression in the file raises
        raise ModelError(f"{file}: {_reason(error)}", path=str(file)) from error
    for name in values:
        if name not in used:
            remarks.append(f"the file does not ask for the argument {name!r}{did_you_mean(name, used)}")
    lines = [line for line in dict.fromkeys(said.getvalue().splitlines()) if line.startswith("warning: ")]
    remarks += [f"xacro {line}" for line in lines if "redefining global symbol" not in line]  # pi, mostly
    return text, remarks


def _check_text(file: Path) -> None:
    raw = file.read_bytes()
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"not UTF-8 text (at byte {error.start}); save it as UTF-8") from None
    if not text.strip():
        raise ValueError("the file is empty")


def _text(value: object) -> str:
    """As a command line would give it: ``true`` for True."""
    return str(value).lower() if isinstance(value, bool) else str(value)


@contextlib.contextmanager
def _patched(xacro: Any, folders: Sequence[Path], remarks: list[str], used: set[str]) -> Iterator[None]:
    """``$(find ...)`` looks in ``folders``; a simulator's extras that are not there are left out and told.

    ``used`` receives the names of arguments that the file asks for.
    """
    substitution = importlib.import_module("xacro.substitution_args")
    argument = substitution._eval_arg

    def find(package: str) -> str:
        for folder in folders:
            if folder.name == package and folder.is_dir():
                return str(folder)
            if (folder / package).is_dir():
                return str(folder / package)
        return f"package://{package}"  # a mesh stays so and is not drawn; an include is told as missing

    def argument_told(name: str, args: Any) -> Any:
        used.add(name)
        return argument(name=name, args=args)

    def folder_of(_: object) -> str:
        return str(Path(xacro.filestack[-1] or ".").absolute().parent)

    include_if_there, call_if_known = _without_extras(xacro, remarks)
    with contextlib.ExitStack() as undo:
        for owner, name, ours in (
            (substitution, "_eval_find", find),
            (substitution, "_eval_arg", argument_told),
            (substitution, "_eval_dirname", folder_of),
            (xacro, "process_include", include_if_there),
            (xacro, "handle_macro_call", call_if_known),
        ):
            undo.callback(setattr, owner, name, getattr(owner, name))
            setattr(owner, name, ours)
        undo.callback(substitution._eval_dict.update, find=substitution._eval_dict["find"])
        substitution._eval_dict["find"] = find
        yield


def _without_extras(xacro: Any, remarks: list[str]) -> tuple[Callable[..., None], Callable[..., Any]]:
    """Xacro's include and macro call, which leave out what is a simulator's and not there."""
    include, call = xacro.process_include, xacro.handle_macro_call
    left_out: list[str] = []

    def include_if_there(node: Any, *others: Any) -> None:
        stack = list(xacro.filestack)
        try:
            include(node, *others)
        except xacro.XacroException as error:
            name = node.getAttribute("filename")
            if not isinstance(error.exc, OSError):
                raise
            if not _EXTRAS.search(name):
                raise ValueError(_missing(name)) from error
            xacro.filestack[:] = stack
            _leave_out(node, f"the file {name!r} is not there", remarks)
            left_out.append(name)

    def call_if_known(node: Any, *others: Any) -> Any:
        try:
            return call(node, *others)
        except xacro.XacroException as error:
            is_extra = left_out and _EXTRAS.search(node.tagName)
            if not (is_extra and str(error).startswith("unknown macro")):
                raise
            _leave_out(node, f"the macro <{node.tagName}> was to come from it", remarks)
            return True

    return include_if_there, call_if_known


def _leave_out(node: Any, why: str, remarks: list[str]) -> None:
    remarks.append(f"left out, as an extra of a simulator: {why}")
    node.parentNode.removeChild(node)


def _missing(name: str) -> str:
    found = re.search(r"\$\(find\s+([^)\s]+)\s*\)", name)
    hint = f"; name the folder that holds the package {found[1]!r} in package_paths" if found else ""
    return f"includes {name!r}, which is not there{hint}"


def _reason(error: Exception) -> str:
    """In one line, without xacro's class names."""
    text = " ".join(str(error).split()) or type(error).__name__
    if "maximum recursion depth" in text:
        return "macros, includes or elements nested too deep"
    undefined = re.search(r"Undefined substitution argument\s+(\S+)", text)
    if undefined:
        name = undefined[1]
        return f"xacro argument {name!r} is not given; pass xacro_arguments={{{name!r}: ...}}"
    if type(error).__module__.startswith("xml."):
        hint = '; declare xmlns:xacro="http://www.ros.org/wiki/xacro"' if "unbound prefix" in text else ""
        return f"not XML: {text}{hint}"
    text = re.sub(r"^<class '[^']*'>: ", "", text)
    half = text[: len(text) // 2]
    return half if text == f"{half} {half}" else text  # xacro repeats the reason
