"""``onorbit show``."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from onorbit_rs.cli.failing import as_far_as_read
from onorbit_rs.cli.options import FolderArgument, JsonOption
from onorbit_rs.cli.saying import say
from onorbit_rs.cli.writing import claim
from onorbit_rs.exceptions import InputError
from onorbit_rs.printable import shell_word


def show(
    folder: FolderArgument,
    viewer: Annotated[bool, typer.Option(help="Open the recording where there is a screen.")] = True,
    picture: Annotated[Path | None, typer.Option(metavar="FILE", help="Save a PNG of the viewer.")] = None,
    at: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="Moment of the picture; its start unless told.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the picture that is there.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Print a run's summary and open its recording.

    Or save a picture of it with --picture.
    """
    from onorbit_rs.cli.printing import print_json
    from onorbit_rs.cli.summary import print_summary
    from onorbit_rs.output.manifest import RECORDING
    from onorbit_rs.output.read import SavedRun
    from onorbit_rs.output.robot import remark_on_robot

    if picture is not None and picture.suffix.lower() != ".png":
        raise InputError(
            f"--picture {picture} is no .png, the one kind of picture there is",
            name="picture", got=picture.suffix, expected=".png",
        )  # fmt: skip
    if at is not None and picture is None:
        raise InputError("--at is the moment of a picture: add --picture FILE", name="at", got=at)
    saved = SavedRun(folder)
    summary = saved.summary()
    _check_moment(at or 0.0, float(summary.get("simulated_s") or 0.0))
    claim(picture, force=force)
    if (picture is not None or (viewer and not as_json)) and (folder / RECORDING).is_file():
        saved.check(RECORDING)
    remark = None if as_json else remark_on_robot(saved, summary)
    with as_far_as_read():
        if as_json:
            print_json(summary)
        else:
            print_summary(summary, folder, is_new=False)
            if remark is not None:
                say(f"note: {remark}")
    if picture is not None:
        save_picture(folder, picture, at or 0.0)
        if not as_json:
            say(f"picture: {picture}")
    elif viewer and not as_json:
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
        say(f"there is no recording here: {recording}")
        return
    way_out = (
        f"save a picture with: onorbit show {shell_word(folder)} --picture FILE.png, "
        f"or open it elsewhere with: rerun {shell_word(recording)}"
    )
    if not has_screen():
        say(f"no screen here; {way_out}")
        return
    try:
        open_recording(recording)
    except ViewerError as error:
        raise ViewerError(f"{error}; {way_out}", reason=error.reason) from error


def _check_moment(at_s: float, end_s: float) -> None:
    """Refuse a moment outside a run that lasted ``end_s``."""
    if not (math.isfinite(at_s) and 0.0 <= at_s <= end_s):
        raise InputError(
            f"--at {at_s:g} s is outside the run, which goes from 0 to {end_s:g} s",
            name="at", got=at_s, expected=f"0 to {end_s:g} s",
        )  # fmt: skip


def save_picture(folder: Path, picture: Path, at_s: float) -> None:
    """Save what the viewer shows at a moment of a run.

    Raises
    ------
    NotFoundError, ViewerError
        There is no recording, or the viewer does not show it.
    OutputFolderError
        It cannot be written.
    """
    from onorbit_rs import viewer

    viewer.take_screenshot(folder / "run.rrd", picture, at_s=at_s)
