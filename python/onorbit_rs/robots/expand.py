"""From xacro to URDF text, with PyPI's ``xacro`` and without ROS."""

from __future__ import annotations

import contextlib
import importlib
import io
import os
import re
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path

from onorbit_rs import reading
from onorbit_rs.exceptions import ModelError, NotFoundError, ReadError
from onorbit_rs.names import did_you_mean
from onorbit_rs.robots.functions import Work
from onorbit_rs.robots.wording import wording
from onorbit_rs.robots.xacro_files import Environment, Files
from onorbit_rs.robots.xacro_parts import replace_parts

_LOCK = threading.Lock()  # xacro keeps its state in globals


def expand(
    path: str | os.PathLike[str],
    package_paths: Sequence[str | os.PathLike[str]] = (),
    arguments: Mapping[str, object] | None = None,
) -> tuple[str, list[str]]:
    """Return the URDF that a xacro file stands for, and remarks on what was left out.

    Parameters
    ----------
    path : path
        The file. Its expressions are evaluated by :mod:`onorbit_rs.robots.expressions`; no code in
        it is executed. It may include and load files of its own package and of packages that
        ``$(find name)`` gives.
    package_paths : sequence of paths
        Folders that hold ROS packages or are one: what ``$(find name)`` gives; the file's parents come after.
    arguments : mapping, optional
        What ``$(arg name)``, ``$(env name)`` and ``$(optenv name)`` give; the environment is not read.

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
    values = {name: _text(value) for name, value in (arguments or {}).items()}
    used: set[str] = set()
    remarks: list[str] = []
    said = io.StringIO()
    work = Work()
    files = Files(file, [Path(folder) for folder in package_paths], work)
    try:
        with _LOCK, contextlib.ExitStack() as undo, contextlib.redirect_stderr(said):
            replace_parts(xacro, undo, files, work, Environment(values, used), remarks)
            document = xacro.process_file(str(file), mappings=_Asked(values, used))
            text = document.documentElement.toxml()
    except RecursionError:
        raise ModelError(f"{file}: macros, includes or elements nested too deep", path=str(file)) from None
    except OSError as error:
        raise ReadError(
            f"cannot read {file}: {error.strerror or error}", path=str(file), kind="robot"
        ) from error
    except Exception as error:  # xacro's own, expat's, and whatever an expression in the file raises
        raise ModelError(f"{file}: {_reason(error)}", path=str(file)) from error
    if not document.getElementsByTagName("link") and b"<xacro:macro" in file.read_bytes():
        raise ModelError(
            f"{file}: defines xacro macros but no robot; expand the file that calls them", path=str(file)
        )
    for name in values:
        if name not in used:
            remarks.append(f"the file does not ask for the argument {name!r}{did_you_mean(name, used)}")
    lines = [line for line in dict.fromkeys(said.getvalue().splitlines()) if line.startswith("warning: ")]
    remarks += [f"xacro {line}" for line in lines if "redefining global symbol" not in line]  # pi, mostly
    return text, remarks


class _Asked(dict[str, str]):
    """Arguments; notes which of them the file asks for."""

    def __init__(self, values: Mapping[str, str], used: set[str]) -> None:
        super().__init__(values)
        self._used = used

    def __getitem__(self, name: str) -> str:
        self._used.add(name)
        return super().__getitem__(name)


def _text(value: object) -> str:
    """As a command line would give it: ``true`` for True."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _reason(error: Exception) -> str:
    """In one line, without xacro's class names."""
    text = " ".join(str(error).split()) or type(error).__name__
    if "maximum recursion depth" in text:
        return "macros, includes or elements nested too deep"
    undefined = re.search(r"Undefined substitution argument\s+(\S+)", text)
    if undefined:
        name = undefined[1]
        return f"xacro argument {name!r} is not given; give it with {wording().argument(name)}"
    if type(error).__module__.startswith("xml."):
        hint = '; declare xmlns:xacro="http://www.ros.org/wiki/xacro"' if "unbound prefix" in text else ""
        return f"not XML: {text}{hint}"
    text = re.sub(r"^<class '[^']*'>: ", "", text)
    half = text[: len(text) // 2]
    return half if text == f"{half} {half}" else text  # xacro repeats the reason
