"""Displays the viewer inside a notebook, as a widget of the package rerun-notebook."""

from __future__ import annotations

import io
import os
import sys
from contextlib import redirect_stdout
from importlib import import_module
from typing import Any

from onorbit_rs.exceptions import ViewerError

INSTALL = "pip install 'onorbit-rs[notebooks]'"
_ASSET = "RERUN_NOTEBOOK_ASSET"
"""Environment variable with the source of the viewer, which rerun-notebook reads when it is imported."""


def check_notebook() -> None:
    """Raise ViewerError if rerun-notebook is not installed, or this is not a notebook."""
    try:
        _rerun_notebook()
    except ImportError:
        raise ViewerError(
            f"the viewer in a notebook requires rerun-notebook; install it with: {INSTALL}",
            reason="rerun-notebook is not installed",
        ) from None
    ipython = sys.modules.get("IPython")
    if ipython is None or ipython.get_ipython() is None:
        raise ViewerError(
            "oo.show displays the viewer only in a notebook; elsewhere, write the run to a folder, and open "
            "it with: onorbit show DIR",
            reason="no notebook",
        )


def display_recording(content: bytes, width: int | None, height: int) -> None:
    """Display the content of a ``.rrd`` file below the cell; call :func:`check_notebook` first.

    Parameters
    ----------
    content : bytes
        Content of the file; it is sent when the viewer in the browser is ready.
    width, height : int or None
        Size, pixels; if ``width`` is None, the viewer is as wide as the notebook.
    """
    from IPython.display import display

    rerun_notebook = _rerun_notebook()
    # the colours of a recording are made for a dark background
    widget = rerun_notebook.Viewer(width="auto" if width is None else width, height=height, theme="dark")
    widget.send_rrd(content)
    display(rerun_notebook.ErrorWidget(), widget)  # the first one is empty if the browser loads the viewer


def _rerun_notebook() -> Any:
    """Import rerun-notebook with the installed copy of the viewer, unless the user has chosen another one.

    By default, the browser would download the viewer, and show nothing without a connection to the internet.
    """
    os.environ.setdefault(_ASSET, "inline")
    with redirect_stdout(io.StringIO()):  # it prints which copy it loads
        return import_module("rerun_notebook")
