"""Implements ``onorbit show``, which prints the summary of a run and opens its recording."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from onorbit_rs.cli.exit_codes import ignore_closed_pipe
from onorbit_rs.cli.options import FolderArgument, JsonOption
from onorbit_rs.cli.output_files import check_output_file
from onorbit_rs.cli.text_output import print_line
from onorbit_rs.common.printable import shell_word
from onorbit_rs.exceptions import InputError


def show(
    folder: FolderArgument,
    viewer: Annotated[bool, typer.Option(help="Open the recording if a display is available.")] = True,
    picture: Annotated[Path | None, typer.Option(metavar="FILE", help="Save a PNG of the viewer.")] = None,
    at: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="Time of the picture; default: 0.")
    ] = None,
    collision: Annotated[
        bool, typer.Option("--collision", help="Show the collision shapes in the picture.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing picture.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Print a run's summary and open its recording.

    With --picture, save a picture of the recording instead of opening it.
    """
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.cli.summary import print_summary
    from onorbit_rs.output.manifest import RECORDING
    from onorbit_rs.output.read import SavedRun
    from onorbit_rs.output.robot import remark_on_robot

    if picture is not None and picture.suffix.lower() != ".png":
        raise InputError(
            f"--picture {picture} must end in .png, the only supported format",
            name="picture", got=picture.suffix, expected=".png",
        )  # fmt: skip
    if at is not None and picture is None:
        raise InputError(f"--at {at:g} sets the time of a picture; add --picture FILE.png", name="at", got=at)
    if collision and picture is None:
        raise InputError(
            "--collision shows the collision shapes in a picture; add --picture FILE.png, or switch on the "
            "entities 'collision' in the blueprint panel of the viewer",
            name="collision", got=True,
        )  # fmt: skip
    saved = SavedRun(folder)
    summary = saved.summary()
    _check_time(at or 0.0, float(summary.get("simulated_s") or 0.0))
    check_output_file(picture, force=force)
    if (picture is not None or (viewer and not as_json)) and (folder / RECORDING).is_file():
        saved.check(RECORDING)
    remark = None if as_json else remark_on_robot(saved, summary)
    with ignore_closed_pipe():
        if as_json:
            print_json(summary)
        else:
            print_summary(summary, folder, is_new=False)
            if remark is not None:
                print_line(f"note: {remark}")
    if picture is not None:
        save_picture(folder, picture, at or 0.0, has_collisions=collision)
        if not as_json:
            print_line(f"picture: {picture}")
    elif viewer and not as_json:
        open_viewer(folder)


def open_viewer(folder: Path) -> None:
    """Open the recording of a run; print a message if there is no recording or no display.

    Raises
    ------
    ViewerError
        If a display is available but the viewer does not open.
    """
    from onorbit_rs.exceptions import ViewerError
    from onorbit_rs.viewer.screen import has_screen, open_recording

    recording = folder / "run.rrd"
    if not recording.is_file():
        again = f"onorbit run {shell_word(folder / 'scenario.yaml')} --out DIR"
        print_line(f"there is no recording to show: {recording} does not exist; to write one: {again}")
        return
    suggestion = (
        f"save a picture with: onorbit show {shell_word(folder)} --picture FILE.png, "
        f"or open it on another machine with: rerun {shell_word(recording)}"
    )
    if not has_screen():
        print_line(f"no display is available; {suggestion}")
        return
    try:
        open_recording(recording)
    except ViewerError as error:
        raise ViewerError(f"{error}; {suggestion}", reason=error.reason) from error


def _check_time(at_s: float, end_s: float) -> None:
    """Raise InputError for a time outside a run that ends at ``end_s``."""
    if not (math.isfinite(at_s) and 0.0 <= at_s <= end_s):
        raise InputError(
            f"--at {at_s:g} is outside the run; give a time from 0 to {end_s:g}, in s",
            name="at", got=at_s, expected=f"0 to {end_s:g} s",
        )  # fmt: skip


def save_picture(folder: Path, picture: Path, at_s: float, *, has_collisions: bool = False) -> None:
    """Save a picture of the viewer at a time of a run, on request with the collision shapes.

    Raises
    ------
    NotFoundError, ViewerError
        If there is no recording, or the viewer cannot show it.
    OutputFolderError
        If the file cannot be written.
    """
    from onorbit_rs import viewer

    viewer.take_screenshot(folder / "run.rrd", picture, at_s=at_s, has_collisions=has_collisions)
