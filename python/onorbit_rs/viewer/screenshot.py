"""Saves a picture of a recording from a headless viewer, which accepts local connections only.

``onorbit show out --picture picture.png --at 1``

A Vulkan driver is required; Debian's ``mesa-vulkan-drivers`` and ``libegl1`` render in software.
"""

from __future__ import annotations

import subprocess
import tempfile
import time
from pathlib import Path
from typing import IO

from rerun.experimental import ViewerClient

from onorbit_rs.common.files import replacing
from onorbit_rs.exceptions import NotFoundError, ViewerError
from onorbit_rs.viewer.screen import command_of, environment, free_port, reason, show_collisions, url_of
from onorbit_rs.viewer.trace_rows import TIMELINE

SETTLE_S = 3.0
"""Wall-clock times, s, to wait for the viewer to draw, before and after setting the simulation time."""


def take_screenshot(
    recording: Path,
    picture: Path,
    *,
    at_s: float = 0.0,
    width: int = 1920,
    height: int = 1080,
    has_collisions: bool = False,
) -> Path:
    """Open a ``.rrd`` file without a window, set the simulation time, and save a picture.

    Parameters
    ----------
    recording : Path
        Recording, such as ``run.rrd``.
    picture : Path
        PNG file to be written.
    at_s : float
        Simulation time, s.
    width, height : int
        Size of the picture, pixels.
    has_collisions : bool
        If True, the collision shapes are shown as well.

    Raises
    ------
    NotFoundError
        If the recording does not exist.
    ViewerError
        If the viewer did not start, or does not show the recording.
    OutputFolderError
        If the picture cannot be written.
    """
    if not recording.is_file():
        message = f"no such recording: {recording}; repeat the run to write a recording"
        raise NotFoundError(message, path=str(recording), kind="recording")
    port = free_port()
    command = [
        *command_of(port),
        "--headless",
        "--hide-welcome-screen",
        *("--window-size", f"{width}x{height}", str(recording.resolve())),
    ]
    with tempfile.TemporaryFile("w+", errors="replace") as said:  # an unread pipe would block the viewer
        try:
            viewer = subprocess.Popen(command, env=environment(), stdout=subprocess.DEVNULL, stderr=said)
        except OSError as error:
            raise _not_started(str(error)) from error
        try:
            image = _picture(_connect(port, viewer, said), viewer, said, at_s, has_collisions=has_collisions)
        finally:
            viewer.kill()
            viewer.wait()
    with replacing(picture) as file:
        file.write_bytes(image)
    return picture


def _picture(
    client: ViewerClient,
    viewer: subprocess.Popen[bytes],
    said: IO[str],
    at_s: float,
    patience_s: float = 60.0,
    *,
    has_collisions: bool = False,
) -> bytes:
    """Return the picture at a time as PNG, after the recording was read."""
    time.sleep(SETTLE_S)
    deadline = time.monotonic() + patience_s
    while True:
        try:
            client.set_time(TIMELINE, duration=at_s, play_state="paused")
            if has_collisions:
                show_collisions(client)
            time.sleep(SETTLE_S)
            return client.take_screenshot()
        except OSError as error:  # the recording is not loaded yet
            has_ended = viewer.poll() is not None
            if has_ended or time.monotonic() > deadline:
                said.seek(0)
                why = reason(said.read()) if has_ended else str(error)
                raise ViewerError(
                    f"the viewer does not display the recording: {why}; repeat the run to write it again",
                    reason=why,
                ) from error
            time.sleep(0.2)


def _connect(
    port: int, viewer: subprocess.Popen[bytes], said: IO[str], patience_s: float = 30.0
) -> ViewerClient:
    """Return a client that is connected to the viewer; raise ViewerError if the viewer does not respond."""
    deadline = time.monotonic() + patience_s
    while time.monotonic() < deadline and viewer.poll() is None:
        try:
            return ViewerClient.connect(url_of(port))
        except OSError:  # the viewer does not answer yet
            time.sleep(0.1)
    said.seek(0)
    raise _not_started(reason(said.read()))


def _not_started(why: str) -> ViewerError:
    return ViewerError(
        f"the headless viewer did not start: {why}; install a Vulkan driver "
        "(Debian: mesa-vulkan-drivers and libegl1)",
        reason=why,
    )
