"""Warnings that are attributed to the user's line of code, not to a line of this package."""

from __future__ import annotations

import os
import sys
import warnings
from pathlib import Path

_PACKAGE = tuple(f"{file.parents[1]}{os.sep}" for file in (Path(__file__), Path(__file__).resolve()))
"""Folder of the package, as Python writes it in the names of files, and with links resolved."""


def warn_user(message: str) -> None:
    """Issue a UserWarning at the innermost line of code outside of this package."""
    level, frame = 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, UserWarning, stacklevel=level)
