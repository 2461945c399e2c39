"""Files that a xacro file may read: those of its package and of other given or found packages."""

from __future__ import annotations

import io
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from onorbit_rs.common.input_files import read_bytes
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import ReadError
from onorbit_rs.robots.functions import Work
from onorbit_rs.robots.wording import wording

_LARGEST = 16 << 20
"""Size limit, bytes, as for a URDF."""


class Files:
    """Opens files that one xacro file includes or loads, and finds packages."""

    def __init__(self, file: Path, package_paths: Sequence[Path], work: Work) -> None:
        """Allow reading in ``package_paths``, in packages found later, and in the package of ``file``.

        If ``file`` is in no package, its folder is used instead of the package.
        """
        self._above = list(file.absolute().parents)
        self._given = [folder.absolute() for folder in package_paths]
        self._work = work
        self._roots = {root for folder in self._given for root in _real(folder)}
        for start in (file.absolute(), file.resolve()):
            own = next((folder for folder in start.parents if _is_package(folder)), start.parent)
            self._roots |= _real(own)

    def find(self, package: str) -> str:
        """Return the folder of a package, searched in ``package_paths`` and in the file's parent folders.

        A parent folder with the name of the package is accepted as it is; a folder inside a parent folder
        must contain a ``package.xml``. If the package is not found, return ``package://name``; its meshes are
        then not drawn, and its includes are reported as missing. Raises ValueError if the name is empty or a
        path.
        """
        if not package:
            raise ValueError(
                "$(find …): the name of the package is empty; write a name, or give a value to the xacro "
                "argument or property from which the name is taken"
            )
        if package in (".", "..") or "/" in package or "\\" in package:
            raise ValueError(
                f"$(find {package}): {package!r} is not a valid package name; give the name without a path"
            )
        for folder in [*self._given, *self._above]:
            beside = folder / package
            if folder.name == package and folder.is_dir():
                return self._found(folder)
            if beside.is_dir() and (folder in self._given or _is_package(beside)):
                return self._found(beside)
        return f"package://{package}"

    def _found(self, folder: Path) -> str:
        self._roots |= _real(folder)
        return str(folder)

    def open(self, name: str | os.PathLike[str], mode: str = "r") -> io.StringIO:
        """Return the text of a file; xacro calls this method instead of Python's ``open``.

        Raises
        ------
        OSError
            If the file does not exist.
        ValueError
            If ``mode`` is not ``r``, or the file is in none of the packages, is not a readable regular file
            of at most 16 MiB, is not UTF-8 text, is empty, or has a document type.
        """
        path = Path(name)
        path.stat()  # a missing file must reach xacro as an OSError
        real = path.resolve()
        if mode != "r":
            raise ValueError(f"{str(name)!r} was opened in mode {mode!r}; a xacro file may only read files")
        if not any(real.is_relative_to(root) for root in self._roots):
            raise ValueError(
                f"{str(name)!r} is in none of the packages from which files may be read; if you trust it, "
                f"give the folder {str(real.parent)!r} with {wording().packages}"
            )
        try:
            raw = read_bytes(path, _LARGEST)
        except ReadError as error:  # an OSError would be attributed to the outermost file
            raise ValueError(error.message) from None
        self._work.spend(len(raw) // 4)
        text = _checked(raw, str(name))
        return io.StringIO(text)

    def glob(self, pattern: str) -> list[str]:
        """Return the sorted files that match an include with ``*``, ``?`` or ``[`` in its last component.

        Raises ValueError if a folder in the include contains one of these characters.
        """
        folder, last = os.path.split(pattern)
        if any(sign in folder for sign in "*?["):
            raise ValueError(
                f"the include {pattern!r} has *, ? or [ in the name of a folder; use them in the name of the "
                "file only"
            )
        return [str(found) for found in sorted(Path(folder or ".").glob(last))] if last else []


class Environment:
    """Values of ``$(env NAME)`` and ``$(optenv NAME default)``, taken from the given arguments."""

    def __init__(self, values: dict[str, str], used: set[str]) -> None:
        """Store the arguments; the names of arguments that the file uses are added to ``used``."""
        self._values, self._used = values, used

    def required(self, name: str) -> str:
        """Return the value of the xacro argument ``name``, which takes the place of an environment variable.

        Raises ValueError if the argument is not given.
        """
        self._used.add(name)
        if name not in self._values:
            hint = did_you_mean(name, self._values)
            raise ValueError(
                f"$(env {name}): environment variables are not read; give the value with "
                f"{wording().argument(name)}{hint}"
            )
        return self._values[name]

    def optional(self, name: str, default: Any = "") -> Any:
        """Return the argument with this name, or the default given in the file."""
        self._used.add(name)
        return self._values.get(name, default)


def _is_package(folder: Path) -> bool:
    return (folder / "package.xml").is_file()


def _real(folder: Path) -> set[Path]:
    """Return the real path of a folder and, if it has a ``package.xml``, of the folder of the real file.

    The two differ if ``colcon build --symlink-install`` linked the file.
    """
    manifest = folder / "package.xml"
    return {folder.resolve()} | ({manifest.resolve().parent} if manifest.is_file() else set())


def _checked(raw: bytes, name: str) -> str:
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(
            f"{name!r} is not UTF-8 text (byte {error.start} is invalid); save it as UTF-8"
        ) from None
    if not text.strip():
        raise ValueError(f"the file {name!r} is empty; write its content, or refer to another file")
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise ValueError(
            f"{name!r} contains a document type declaration (<!DOCTYPE ...>), which is not accepted, because "
            "its entities can expand to any length; remove the declaration"
        )
    return text
