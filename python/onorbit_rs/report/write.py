"""Writes ``report.html`` of a run from the files in its folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from onorbit_rs import _core
from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.output.manifest import FIGURES, REPORT
from onorbit_rs.output.read import SavedRun, read_summary
from onorbit_rs.output.replacement import Replacement
from onorbit_rs.report.page import page
from onorbit_rs.report.subjects import figures_of, subject_of_run, world_figures
from onorbit_rs.report.template import Picture
from onorbit_rs.report.world_page import world_page
from onorbit_rs.scenario import WorldScenario

if TYPE_CHECKING:
    from onorbit_rs.report.subjects import OwnDrawing

LARGEST_SVG = 600_000
"""Largest size of an SVG, bytes; larger figures are embedded as PNG."""


def write_report(
    folder: str | os.PathLike[str],
    *,
    pdf: bool = False,
    tell: Callable[[str, float], None] = lambda doing, done: None,
) -> Path:
    """Write ``report.html``, a self-contained page, to the folder of a run.

    Parameters
    ----------
    folder : str or path
        The ``out`` folder of :func:`onorbit_rs.run`.
    pdf : bool
        Also write each figure to ``figures/`` as PDF.
    tell : callable
        Called with the next task and the completed fraction of the work, 0 to 1.

    Returns
    -------
    Path
        Path of the page.

    Raises
    ------
    NotFoundError, ReadError
        If there is no run in this folder, or its files cannot be read.
    IntegrityError
        If the files were changed after the run.
    ScenarioError
        If this version rejects the scenario of the run.
    OutputFolderError
        If the page cannot be written, or another process writes to the folder.
    """
    path = Path(folder)
    read_summary(path)  # raises before anything is written
    with OutputFolder(path) as out, out.replacing() as files:
        out.check_replaceable(REPORT)
        return _write_report(out.path, files, pdf=pdf, tell=tell)


def _write_report(folder: Path, files: Replacement, *, pdf: bool, tell: Callable[[str, float], None]) -> Path:
    """Write the page and its figures; return the path of the page."""
    saved = SavedRun(folder)
    summary = saved.summary()
    text, scenario = saved.scenario_text(), saved.scenario()
    remarks: list[str] = []
    tell("reading the trace", 0.0)
    is_drawn = summary.get("status") != "diverged"
    if not is_drawn:
        remarks.append("the run diverged: figures are not drawn")
    write = partial(_pictures, files=files, pdf=pdf, tell=tell)
    around: dict[str, Any] = {
        "description": scenario.description, "scenario": text, "remarks": remarks,
        "again": "onorbit run scenario.yaml", "version": str(_core.build_info()["version"]),
    }  # fmt: skip
    if isinstance(scenario, WorldScenario):
        found = world_figures(saved, scenario, summary, remarks) if is_drawn else []
        pictures = write(found)
        names = ["", *scenario.systems]
        by_system = {name: [picture for owner, picture in pictures if owner == name] for name in names}
        tell("writing the page", 1.0)
        content = world_page(summary, pictures=by_system, **around)
    else:
        subject = subject_of_run(saved, scenario, summary, remarks)
        pictures = write(figures_of(subject, "") if is_drawn else [])
        tell("writing the page", 1.0)
        content = page(summary, pictures=[picture for _, picture in pictures], **around)
    with files.writing(REPORT) as file:
        file.write_text(content, encoding="utf-8")
    return folder / REPORT


def _pictures(
    found: Sequence[OwnDrawing], files: Replacement, pdf: bool, tell: Callable[[str, float], None]
) -> list[tuple[str, Picture]]:
    """Return the pictures with the systems to which they belong; write them as PDF too if ``pdf`` is set."""
    from onorbit_rs import figures

    pictures = []
    for number, (system, name, drawing) in enumerate(found):
        tell(f"drawing {name}, {number + 1} of {len(found)}", number / len(found))
        figure = drawing.draw()
        kind, content = "svg", figures.as_bytes(figure, "svg")
        if len(content) > LARGEST_SVG:
            kind, content = "png", figures.as_bytes(figure, "png")
        if pdf:
            with files.writing(f"{FIGURES}/{name}.pdf") as file:
                file.write_bytes(figures.as_bytes(figure, "pdf"))
        is_wide = figure.get_figwidth() > figures.COLUMN
        pictures.append((system, Picture(name, drawing.caption, kind, content, is_wide)))
    return pictures
