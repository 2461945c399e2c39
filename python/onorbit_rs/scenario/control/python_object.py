"""Executes the file or module of a controller written in Python, and creates its object."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import sys
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.user_code import announce
from onorbit_rs.exceptions import ControlError
from onorbit_rs.scenario.control.python_errors import no_class, no_module, no_python, no_update
from onorbit_rs.scenario.control.python_source import source_of

if TYPE_CHECKING:
    from onorbit_rs.scenario.control.python import PythonController


def create_controller(part: PythonController, folder: Path) -> Any:
    """Return a new object of the user's class, after executing its file or importing its module.

    Parameters
    ----------
    part : PythonController
        Controller in the scenario.
    folder : path
        Folder of the scenario; relative paths start there.

    Raises
    ------
    NotFoundError, ReadError
        If there is no such file or module, or it is a folder, a pipe or a device.
    ControlError
        If the file, the module or the constructor raises an error, or the class or its method ``update`` is
        missing.
    """
    announce(source_of(part, folder))
    source = str(folder / part.file) if part.file is not None else str(part.module)
    module = _execute_file(folder / part.file) if part.file is not None else _import(source)
    controller_class = getattr(module, part.class_, None)
    if not inspect.isclass(controller_class):
        classes = [
            name
            for name, value in vars(module).items()
            if inspect.isclass(value) and value.__module__ == module.__name__
        ]
        raise no_class(part.class_, source, classes)
    if not callable(getattr(controller_class, "update", None)) or inspect.isabstract(controller_class):
        raise no_update(part.class_, source)
    try:
        return controller_class(**part.arguments)
    except Exception as error:
        raise ControlError(
            f"{part.class_}(...) of {source} raised {_one_line(error)}; correct the class or its "
            f"'arguments', {part.arguments}",
            name="arguments",
            got=part.arguments,
        ) from error


def _execute_file(file: Path) -> ModuleType:
    name = f"onorbit_controller_{file.stem}"
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise no_python(str(file))
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses search their module there
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        message = f"the controller's file {file} raised {_one_line(error)}; correct the file"
        raise ControlError(message, name="file", got=str(file)) from error
    return module


def _import(name: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name and (name == error.name or name.startswith(f"{error.name}.")):
            raise no_module(name) from error
        message = f"module {name} raised {_one_line(error)}; install the missing module"
        raise ControlError(message, name="module", got=name) from error
    except Exception as error:
        message = f"the controller's module {name} raised {_one_line(error)}; correct the module"
        raise ControlError(message, name="module", got=name) from error


def _one_line(error: Exception) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"
