"""Executes the file or module of a class written in Python, and creates its object."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import sys
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.user_code import announce
from onorbit_rs.scenario.user_code.errors import is_abstract, no_class, no_method, no_module, no_python
from onorbit_rs.scenario.user_code.source import source_of

if TYPE_CHECKING:
    from onorbit_rs.scenario.user_code.part import UserClass


def create_object(part: UserClass, folder: Path) -> Any:
    """Return a new object of the user's class, after executing its file or importing its module.

    Parameters
    ----------
    part : UserClass
        Part of the scenario.
    folder : path
        Folder of the scenario; relative paths start there.

    Raises
    ------
    NotFoundError, ReadError
        If there is no such file or module, or it is a folder, a pipe or a device.
    ControlError, EffectError
        If the file, the module or the constructor raises an error, or the class or its method is missing.
    """
    announce(source_of(part, folder))
    source = str(folder / part.file) if part.file is not None else str(part.module)
    module = _execute_file(part, folder / part.file) if part.file is not None else _import(part, source)
    user_class = getattr(module, part.class_, None)
    if not inspect.isclass(user_class):
        classes = [
            name
            for name, value in vars(module).items()
            if inspect.isclass(value) and value.__module__ == module.__name__
        ]
        raise no_class(part, source, classes)
    missing = sorted(getattr(user_class, "__abstractmethods__", ()))
    if not callable(getattr(user_class, part.method_name, None)) or part.method_name in missing:
        raise no_method(part, source)
    if missing:
        raise is_abstract(part, source, missing)
    try:
        return user_class(**part.arguments)
    except Exception as error:
        raise part.error(
            f"{part.class_}(...) of {source} raised {_one_line(error)}; correct the class or its "
            f"'arguments' ({part.arguments or 'none are given'})",
            name="arguments",
            got=part.arguments,
        ) from error


def _execute_file(part: UserClass, file: Path) -> ModuleType:
    name = f"onorbit_{part.role}_{file.stem}"
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        raise no_python(part, str(file))
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses search their module there
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        message = f"the {part.role}'s file {file} raised {_one_line(error)}; correct the file"
        raise part.error(message, name="file", got=str(file)) from error
    return module


def _import(part: UserClass, name: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name and (name == error.name or name.startswith(f"{error.name}.")):
            raise no_module(part) from error
        message = f"module {name} raised {_one_line(error)}; install the missing module"
        raise part.error(message, name="module", got=name) from error
    except Exception as error:
        message = f"the {part.role}'s module {name} raised {_one_line(error)}; correct the module"
        raise part.error(message, name="module", got=name) from error


def _one_line(error: Exception) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"
