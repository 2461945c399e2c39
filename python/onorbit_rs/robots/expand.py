"""Expands xacro files to URDF text with PyPI's ``xacro``, without ROS."""

from __future__ import annotations

import contextlib
import importlib
import io
import os
import re
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from onorbit_rs.common import input_files
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import ModelError, NotFoundError, ReadError
from onorbit_rs.robots.functions import Work
from onorbit_rs.robots.nesting import TOO_DEEP, NestingError
from onorbit_rs.robots.wording import wording
from onorbit_rs.robots.xacro_files import Environment, Files
from onorbit_rs.robots.xacro_parts import replace_parts

_LOCK = threading.Lock()  # xacro keeps its state in global variables


def expand(
    path: str | os.PathLike[str],
    package_paths: Sequence[str | os.PathLike[str]] = (),
    arguments: Mapping[str, object] | None = None,
) -> tuple[str, list[str]]:
    """Return the URDF text of a xacro file, and remarks on omitted parts, unused arguments and warnings.

    Parameters
    ----------
    path : path
        Xacro file. Its expressions are evaluated by :mod:`onorbit_rs.robots.expressions`; no code in
        it is executed. It may include and load files of its package, of ``package_paths`` and of packages
        that ``$(find name)`` finds.
    package_paths : sequence of paths
        ROS packages or folders of ROS packages, for ``$(find name)``; the parent folders of the file are
        searched after them.
    arguments : mapping, optional
        Values of ``$(arg name)``, ``$(env name)`` and ``$(optenv name)``; the environment is not read.

    Returns
    -------
    urdf : str
        Text of the expanded file.
    remarks : list of str
        Omitted parts, unused arguments and warnings of xacro.

    Raises
    ------
    NotFoundError, ReadError
        If there is no such file, or it cannot be read.
    ModelError
        If ``xacro`` is not installed, or the file cannot be expanded.
    """
    file = Path(path)
    xacro = _import_xacro(file)
    values = {name: _text(value) for name, value in (arguments or {}).items()}
    used: set[str] = set()
    remarks: list[str] = []
    output = io.StringIO()
    with contextlib.redirect_stderr(output):
        document, text = _expanded(xacro, file, package_paths, values, used, remarks)
    if not document.getElementsByTagName("link") and b"<xacro:macro" in file.read_bytes():
        raise ModelError(
            f"{file} defines xacro macros, but its expansion contains no link; give the file that calls the "
            "macros",
            path=str(file),
        )
    for name in values:
        if name not in used:
            remarks.append(f"the file does not use the argument {name!r}{did_you_mean(name, used)}")
    lines = [line for line in dict.fromkeys(output.getvalue().splitlines()) if line.startswith("warning: ")]
    remarks += [f"xacro {line}" for line in lines if "redefining global symbol" not in line]  # usually pi
    return text, remarks


def _import_xacro(file: Path) -> Any:
    """Return PyPI's xacro, after checking that the file can be read."""
    if not file.exists():
        raise NotFoundError(f"no such file: {file}; check the path", path=str(file), kind="robot")
    if file.is_dir():
        raise ReadError(f"{file} is a folder; give a xacro file", path=str(file), kind="robot")
    input_files.check_regular(file, "robot")
    try:
        return importlib.import_module("xacro")
    except ImportError as error:
        raise ModelError(
            f"{file}: xacro files require PyPI's xacro, which is not installed: "
            "pip install 'onorbit-rs[xacro]'",
            path=str(file),
        ) from error


def _expanded(
    xacro: Any,
    file: Path,
    package_paths: Sequence[str | os.PathLike[str]],
    values: dict[str, str],
    used: set[str],
    remarks: list[str],
) -> tuple[Any, str]:
    """Return the expanded document and its text; convert errors to errors that name the file.

    A nesting error is converted after the block that handles it. Otherwise, it would be the context of the
    error of this package, and programs that pickle contexts, among them Dask, cannot pickle its traceback.
    """
    try:
        document = _process(xacro, file, package_paths, values, used, remarks)
        return document, document.documentElement.toxml()
    except OSError as error:
        raise ReadError(
            f"cannot read {file}: {error.strerror or error}", path=str(file), kind="robot"
        ) from error
    except Exception as error:  # raised by xacro, by expat, or by an expression in the file
        reason = _reason(error)
        if not _is_too_deep(error):
            raise ModelError(f"{file}: {reason}", path=str(file)) from error
    raise ModelError(f"{file}: {reason}", path=str(file))


def _process(
    xacro: Any,
    file: Path,
    package_paths: Sequence[str | os.PathLike[str]],
    values: dict[str, str],
    used: set[str],
    remarks: list[str],
) -> Any:
    """Return the expanded document, and record the used arguments and the remarks."""
    work = Work()
    files = Files(file, [Path(folder) for folder in package_paths], work)
    with _LOCK, contextlib.ExitStack() as undo:
        replace_parts(xacro, undo, files, work, Environment(values, used), remarks)
        return xacro.process_file(str(file), mappings=_Arguments(values, used))


class _Arguments(dict[str, str]):
    """Arguments by name; the names of arguments that the file uses are recorded."""

    def __init__(self, values: Mapping[str, str], used: set[str]) -> None:
        super().__init__(values)
        self._used = used

    def __getitem__(self, name: str) -> str:
        self._used.add(name)
        return super().__getitem__(name)


def _text(value: object) -> str:
    """Return a value as text, as written on a command line: ``true`` for True."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _reason(error: Exception) -> str:
    """Return the message of an error in one line, without class names of xacro."""
    text = " ".join(str(error).split()) or type(error).__name__
    if _is_too_deep(error):
        return text if isinstance(error, NestingError) else TOO_DEEP
    undefined = re.search(r"Undefined substitution argument\s+(\S+)", text)
    if undefined:
        name = undefined[1]
        return f"xacro argument {name!r} is not given; give it with {wording().argument(name)}"
    if type(error).__module__.startswith("xml."):
        hint = '; declare xmlns:xacro="http://www.ros.org/wiki/xacro"' if "unbound prefix" in text else ""
        return f"the file is not valid XML: {text}{hint}"
    text, *expressions = re.sub(r"^<class '[^']*'>: ", "", text).split(" when evaluating expression ")
    half = text[: len(text) // 2]
    reason = half if text == f"{half} {half}" else text  # xacro repeats the reason
    if not expressions:
        return reason
    return f"expression {', used in '.join(map(_shortened, expressions))}: {reason}"


def _is_too_deep(error: Exception) -> bool:
    """Return True if an error, or the error that xacro converted to it, is due to nesting."""
    return isinstance(error, RecursionError) or "maximum recursion depth" in str(error)


def _shortened(text: str) -> str:
    """Return an expression, cut off after 100 characters, for a message."""
    return text if len(text) <= 100 else f"{text[:100]} ..."
