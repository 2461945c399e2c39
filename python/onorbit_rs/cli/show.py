"""Implements ``onorbit show``, which prints the summary of a run and opens its recording."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from onorbit_rs.cli.exit_codes import ignore_closed_pipe
from onorbit_rs.cli.options import FolderArgument, JsonOption
from onorbit_rs.cli.output_files import check_output_file
from onorbit_rs.cli.picture import View, save_picture
from onorbit_rs.cli.text_output import print_line
from onorbit_rs.common.printable import shell_word
from onorbit_rs.exceptions import InputError


def show(
    folder: FolderArgument,
    viewer: Annotated[bool, typer.Option(help="Open the recording if a display is available.")] = True,
    picture: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw the scene as a PNG file; requires no display.")
    ] = None,
    at: Annotated[
        float | None, typer.Option(metavar="SECONDS", help="Time of the picture, s; default: 0.")
    ] = None,
    size: Annotated[
        str | None,
        typer.Option(metavar="WIDTHxHEIGHT", help="Size of the picture, pixels; default: 1920x1080."),
    ] = None,
    eye: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,Z", help="Position of the camera, relative to the base of the first robot, m."
        ),
    ] = None,
    look_at: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,Z",
            help="Point in the middle of the picture, relative to the base of the first robot, m.",
        ),
    ] = None,
    collision: Annotated[
        bool, typer.Option("--collision", help="Draw the collision shapes in the picture.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing picture.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Print a run's summary and open its recording.

    With --picture, draw the scene at a time of the run instead of opening the recording. The axes of --eye
    and --look-at are those of L (x away from the Earth, y along the track), or of W without an orbit.
    """
    from onorbit_rs.cli.console import print_json
    from onorbit_rs.cli.summary import print_summary
    from onorbit_rs.output.manifest import RECORDING
    from onorbit_rs.output.read import SavedRun
    from onorbit_rs.output.robot import remark_on_robot

    if picture is not None and picture.suffix.lower() != ".png":
        raise InputError(
            f"--picture: the file name {picture} must end in .png, the only supported format",
            name="picture", got=picture.suffix, expected=".png",
        )  # fmt: skip
    view = View.of(at, size, eye, look_at, is_collision=collision)
    if picture is None:
        view.check_unused()
    saved = SavedRun(folder)
    summary = saved.summary()
    view.check_time(float(summary.get("simulated_s") or 0.0))
    check_output_file(picture, force=force)
    if picture is None and viewer and not as_json and (folder / RECORDING).is_file():
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
        save_picture(saved, summary, picture, view)
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
