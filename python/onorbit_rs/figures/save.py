"""Saves figures as PNG, PDF or SVG."""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
from matplotlib.figure import Figure

from onorbit_rs.common.files import replacing
from onorbit_rs.figures.drawings import drawings

if TYPE_CHECKING:
    from onorbit_rs.figures.subject import Subject

FORMATS = ("png",)
"""Formats that a run writes; ``onorbit report`` also writes PDF."""
# publishers reject Type 3 fonts, and 42 selects TrueType; the hash salt makes files reproducible
_SETTINGS: Any = {"pdf.fonttype": 42, "svg.hashsalt": "onorbit", "path.simplify_threshold": 0.2}
_NO_DATE: dict[str, dict[str, Any]] = {
    "png": {"Software": None}, "pdf": {"CreationDate": None}, "svg": {"Date": None},
}  # fmt: skip


def save_all(
    subject: Subject,
    folder: Path,
    *,
    formats: Sequence[str] = FORMATS,
    tell: Callable[[str], None] | None = None,
) -> list[Path]:
    """Write every figure that applies to a run.

    Parameters
    ----------
    subject : Subject
        Run to be drawn.
    folder : Path
        Folder for the figures; created if it does not exist.
    formats : sequence of str
        Any of ``png``, ``pdf`` and ``svg``.
    tell : callable, optional
        Called with the name of each figure before it is drawn.

    Returns
    -------
    list of Path
        Paths of the written files.
    """
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for drawing in drawings(subject):
        if tell is not None:
            tell(drawing.name)
        figure = drawing.draw()
        for kind in formats:
            files.append(folder / f"{drawing.name}.{kind}")
            files[-1].write_bytes(as_bytes(figure, kind))
    return files


def save(figure: Figure, file: Path) -> None:
    """Save a figure as PNG, PDF or SVG, by the suffix of the file name; an existing file is replaced.

    Raises
    ------
    OutputFolderError
        If the file cannot be written.
    """
    with replacing(file) as temporary:
        temporary.write_bytes(as_bytes(figure, file.suffix[1:].lower()))


def as_bytes(figure: Figure, kind: str) -> bytes:
    """Return the content of a figure file; ``kind`` is ``png``, ``pdf`` or ``svg``."""
    content = io.BytesIO()
    with warnings.catch_warnings(), mpl.rc_context(_SETTINGS):
        warnings.filterwarnings(
            "ignore", message="Glyph .* missing"
        )  # a name in a script that the font lacks
        figure.savefig(content, format=kind, metadata=_NO_DATE[kind])
    return content.getvalue()
