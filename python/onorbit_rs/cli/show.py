"""``onorbit show``."""

from __future__ import annotations

import math
import shlex
from pathlib import Path
from typing import Annotated

import typer

from onorbit_rs.cli.options import FolderArgument, JsonOption
from onorbit_rs.cli.writing import writing
from onorbit_rs.exceptions import InputError


def show(
    folder: FolderArgument,
    viewer: Annotated[bool, typer.Option(help="Open the recording where there is a screen.")] = True,
    picture: Annotated[Path | None, typer.Option(metavar="FILE", help="Save a PNG of the viewer.")] = None,
    at: Annotated[float, typer.Option(metavar="SECONDS", help="Moment of the picture.")] = 0.0,
    as_json: JsonOption = False,
) -> None:
    """Print the summary of a run and open its recording, or save a picture of it."""
    from onorbit_rs.cli.printing import print_json, print_summary
    from onorbit_rs.output.read import read_summary

    if picture is not None and picture.suffix.lower() != ".png":
        raise InputError(
            f"--picture {picture} is no .png, the one kind of picture there is",
            name="picture", got=picture.suffix, expected=".png",
        )  # fmt: skip
    summary = read_summary(folder)
    if as_json:
        print_json(summary)
        return
    print_summary(summary, folder, is_new=False)
    if picture is not None:
        save_picture(folder, picture, at, float(summary.get("simulated_s") or 0.0))
    elif viewer:
        open_viewer(folder)


def open_viewer(folder: Path) -> None:
    """Open the recording of a run where there is a screen, or say how.

    Raises
    ------
    ViewerError
        There is a screen, and the viewer does not open on it.
    """
    from onorbit_rs.exceptions import ViewerError
    from onorbit_rs.viewer.screen import has_screen, open_recording

    recording = folder / "run.rrd"
    if not recording.is_file():
        typer.echo(f"there is no recording here: {recording}")
        return
    way_out = (
        f"save a picture with: onorbit show {shlex.quote(str(folder))} --picture FILE.png, "
        f"or open it elsewhere with: rerun {shlex.quote(str(recording))}"
    )
    if not has_screen():
        typer.echo(f"no screen here; {way_out}")
        return
    try:
        open_recording(recording)
    except ViewerError as error:
        raise ViewerError(f"{error}; {way_out}", reason=error.reason) from error


def save_picture(folder: Path, picture: Path, at_s: float, end_s: float) -> None:
    """Save what the viewer shows at a moment of a run that lasted ``end_s``.

    Raises
    ------
    InputError
        The moment is outside the run.
    OutputFolderError
        The picture cannot be written.
    """
    from onorbit_rs import viewer

    if not (math.isfinite(at_s) and 0.0 <= at_s <= end_s):
        raise InputError(
            f"--at {at_s:g} s is outside the run, which goes from 0 to {end_s:g} s",
            name="at", got=at_s, expected=f"0 to {end_s:g} s",
        )  # fmt: skip
    with writing(picture):
        viewer.take_screenshot(folder / "run.rrd", picture, at_s=at_s)
    typer.echo(f"picture: {picture}")
