"""A controller of the user's, from a file or a module."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from onorbit_rs.exceptions import ControlError
from onorbit_rs.foreign_code import announce
from onorbit_rs.scenario.control import PythonController
from onorbit_rs.scenario.controller_refusals import no_class, no_module, no_python, no_update
from onorbit_rs.scenario.python_source import source_of


def python_controller(part: PythonController, beside: Path) -> Any:
    """Execute the file or import the module of a controller and return the user's object, fresh.

    Raises
    ------
    NotFoundError, ReadError
        No such file or module; a folder, a pipe or a device.
    ControlError
        Its file, its module or its constructor raises, or it has no such class, or that no ``update``.
    """
    announce(source_of(part, beside))
    source = str(beside / part.file) if part.file is not None else str(part.module)
    module = _from_file(beside / part.file) if part.file is not None else _imported(source)
    made = getattr(module, part.class_, None)
    if not inspect.isclass(made):
        classes = [
            name
            for name, value in vars(module).items()
            if inspect.isclass(value) and value.__module__ == module.__name__
        ]
        raise no_class(part.class_, source, classes)
    if not callable(getattr(made, "update", None)) or inspect.isabstract(made):
        raise no_update(part.class_, source)
    try:
        return made(**part.arguments)
    except Exception as error:
        raise ControlError(
            f"{part.class_}(...) of {source} raised {_told(error)}; its arguments are {part.arguments}",
            name="arguments",
            got=part.arguments,
        ) from error


def _from_file(file: Path) -> ModuleType:
    name = f"onorbit_controller_{file.stem}"
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise no_python(str(file))
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses look themselves up there
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise ControlError(f"{file} raised {_told(error)}", name="file", got=str(file)) from error
    return module


def _imported(name: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name and (name == error.name or name.startswith(f"{error.name}.")):
            raise no_module(name) from error
        raise ControlError(f"module {name} raised {_told(error)}", name="module", got=name) from error
    except Exception as error:
        raise ControlError(f"module {name} raised {_told(error)}", name="module", got=name) from error


def _told(error: Exception) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"
