"""Writes ``report.html`` of a run from the files in its folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from onorbit_rs import _core
from onorbit_rs.exceptions import InputError, OnOrbitError
from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.output.manifest import FIGURES, REPORT
from onorbit_rs.output.read import SavedRun, read_summary
from onorbit_rs.output.replacement import Replacement
from onorbit_rs.output.robot import CHANGED, was_changed
from onorbit_rs.report.page import Picture, page
from onorbit_rs.scenario import Scenario
from onorbit_rs.scenario.environment.earth import build_earth

if TYPE_CHECKING:
    from onorbit_rs.figures import Subject

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
        The page.

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
    if "systems" in read_summary(path):  # raises before anything is written
        raise InputError(
            "a report of a run with 'systems' is not available yet; its figures are in the folder 'figures'",
            name="folder", got=str(path),
        )  # fmt: skip
    with OutputFolder(path) as out, out.replacing() as files:
        out.check_replaceable(REPORT)
        return _write_report(out.path, files, pdf=pdf, tell=tell)


def _write_report(folder: Path, files: Replacement, *, pdf: bool, tell: Callable[[str, float], None]) -> Path:
    """Write the page and its figures; return the path of the page."""
    saved = SavedRun(folder)
    summary = saved.summary()
    text, scenario = saved.scenario_text(), saved.scenario()
    assert isinstance(scenario, Scenario)  # as in the summary
    remarks: list[str] = []
    tell("reading the trace", 0.0)
    subject = _subject(saved, scenario, summary, remarks)
    pictures: list[Picture] = []
    if summary.get("status") == "diverged":
        remarks.append("the run diverged: figures are not drawn")
    elif len(subject.trace.time) > 1:
        pictures = list(_pictures(subject, files, pdf, tell))
    tell("writing the page", 1.0)
    version = str(_core.build_info()["version"])
    content = page(
        summary,
        description=scenario.description,
        scenario=text,
        pictures=pictures,
        remarks=remarks,
        again="onorbit run scenario.yaml",
        version=version,
    )
    with files.writing(REPORT) as file:
        file.write_text(content, encoding="utf-8")
    return folder / REPORT


def _subject(saved: SavedRun, scenario: Scenario, summary: dict[str, Any], remarks: list[str]) -> Subject:
    """Return the subject of the figures; unreadable robots, orbits and Earth models become remarks."""
    from onorbit_rs import figures

    trace, folder = saved.trace(), saved.folder
    model = orbit = earth = None
    with _remarked(remarks, "the robot could not be read; figures that show it are omitted"):
        model = scenario.robot.build(scenario)
        if was_changed(model, summary):
            model = None
            remarks.append(f"{CHANGED}; figures that show it are omitted")
    with _remarked(remarks, "the orbit could not be read; figures that show it are omitted"):
        orbit = None if scenario.orbit is None else scenario.orbit.build(folder)
        earth = build_earth(scenario.earth, scenario.epoch, orbit, folder)
    return figures.subject_of(trace, scenario, model, orbit, earth)


@contextmanager
def _remarked(remarks: list[str], what: str) -> Iterator[None]:
    try:
        yield
    except OnOrbitError as error:
        remarks.append(f"{what}: {error}")


def _pictures(
    subject: Subject, files: Replacement, pdf: bool, tell: Callable[[str, float], None]
) -> Iterator[Picture]:
    from onorbit_rs import figures

    drawings = list(figures.drawings(subject))
    for number, drawing in enumerate(drawings):
        tell(f"drawing {drawing.name}, {number + 1} of {len(drawings)}", number / len(drawings))
        figure = drawing.draw()
        kind, content = "svg", figures.as_bytes(figure, "svg")
        if len(content) > LARGEST_SVG:
            kind, content = "png", figures.as_bytes(figure, "png")
        if pdf:
            with files.writing(f"{FIGURES}/{drawing.name}.pdf") as file:
                file.write_bytes(figures.as_bytes(figure, "pdf"))
        is_wide = figure.get_figwidth() > figures.COLUMN
        yield Picture(drawing.name, drawing.caption, kind, content, is_wide)
