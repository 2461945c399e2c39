"""Displays the viewer inside a notebook, as a widget of the package rerun-notebook."""

from __future__ import annotations

import sys

from onorbit_rs.exceptions import ViewerError

INSTALL = "pip install 'onorbit-rs[notebooks]'"


def check_notebook() -> None:
    """Raise ViewerError if rerun-notebook is not installed, or this is not a notebook."""
    try:
        import rerun_notebook  # noqa: F401
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
    import rerun_notebook
    from IPython.display import display

    widget = rerun_notebook.Viewer(width="auto" if width is None else width, height=height)
    widget.send_rrd(content)
    display(rerun_notebook.ErrorWidget(), widget)  # the first one is empty if the browser loads the viewer
