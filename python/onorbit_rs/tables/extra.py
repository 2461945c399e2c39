"""Optional packages for tables."""

from __future__ import annotations

import importlib
from importlib.util import find_spec
from typing import Any

from onorbit_rs.exceptions import NotFoundError

HINT = "pip install 'onorbit-rs[tables]'"


def required(package: str, what: str) -> Any:
    """Import an optional package, and return it; ``what`` names the feature that requires it.

    Raises
    ------
    NotFoundError
        If the package is not installed; the message contains the command that installs it.
    """
    if find_spec(package) is None:
        raise NotFoundError(f"{what} requires {package}; to install it: {HINT}", path=package, kind="package")
    return importlib.import_module(package)
