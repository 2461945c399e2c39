"""The viewer window, in a separate process that accepts local connections only."""

from __future__ import annotations

import os
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import IO

import rerun_cli  # type: ignore[import-untyped]  # ships no types
from rerun.experimental import ViewerClient

from onorbit_rs.exceptions import ViewerError

START_PATIENCE_S = 20.0
"""Longest wall-clock time to wait for the viewer to start, s."""

_BINARIES = ("rerun", "rerun.exe", "Rerun.app/Contents/MacOS/Rerun")
_PANIC = re.compile(r"panicked at '(.*)'$", re.MULTILINE)
_LOCAL = "127.0.0.1"


def has_screen() -> bool:
    """Return True if a window can be opened."""
    on_linux = sys.platform.startswith("linux")
    return not on_linux or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def open_recording(recording: Path) -> None:
    """Open a ``.rrd`` file and return when the window is open; the viewer continues after this process ends.

    Raises
    ------
    ViewerError
        If the viewer cannot be started, ends before it opens a window, or does not respond within 20 s.
    """
    _start(free_port(), str(recording))


def open_viewer() -> str:
    """Start a viewer that waits for rows, and return its URL.

    Raises
    ------
    ViewerError
        If the viewer cannot be started, ends before it opens a window, or does not respond within 20 s.
    """
    port = free_port()
    _start(port, "--expect-data-soon")
    return url_of(port)


def url_of(port: int) -> str:
    """Return the URL of the viewer at a port."""
    return f"rerun+http://{_LOCAL}:{port}/proxy"


def command_of(port: int) -> list[str]:
    """Return the command of the viewer's executable; ``python -m rerun_cli`` would not stop it on exit."""
    places = [Path(rerun_cli.__file__).parent / name for name in _BINARIES]
    binary = next((place for place in places if place.is_file()), places[0])
    return [str(binary), "--bind", _LOCAL, "--port", str(port)]


def environment() -> dict[str, str]:
    """Return the environment variables of a viewer: no welcome screen, and only errors on stderr."""
    return os.environ | {"RERUN_APP_ONLY": "true", "RUST_LOG": "error"}


def listens(port: int) -> bool:
    """Return True if a process listens at this local port."""
    with socket.socket() as probe:
        return probe.connect_ex((_LOCAL, port)) == 0


def free_port() -> int:
    """Return a free local port."""
    with socket.socket() as probe:
        probe.bind((_LOCAL, 0))
        return int(probe.getsockname()[1])


def reason(printed: str) -> str:
    """Return the reason why a viewer ended: its panic or last output line, without source positions."""
    if panic := _PANIC.search(printed):
        return panic[1]
    lines = printed.strip().splitlines()
    return lines[-1].rsplit(": ", 1)[-1] if lines else "it printed no reason"


def _start(port: int, *arguments: str) -> None:
    command = [*command_of(port), *arguments]
    with tempfile.TemporaryFile("w+", errors="replace") as said:
        try:
            viewer = subprocess.Popen(
                command, env=environment(), start_new_session=True, stdout=subprocess.DEVNULL, stderr=said
            )
        except OSError as error:
            raise _not_started(str(error)) from error
        try:
            _await_window(viewer, port, said)
        except BaseException:  # includes Ctrl-C: the viewer has a separate session and would keep running
            viewer.kill()
            viewer.wait()
            raise


def _await_window(viewer: subprocess.Popen[bytes], port: int, said: IO[str]) -> None:
    """Wait until the viewer responds, or until the timeout if it listens but has no window yet."""
    answered = threading.Event()
    deadline = time.monotonic() + START_PATIENCE_S
    asked: threading.Thread | None = None
    while not answered.is_set() and time.monotonic() < deadline:
        if viewer.poll() is not None:
            said.seek(0)
            raise _not_started(reason(said.read()))
        if (asked is None or not asked.is_alive()) and listens(port):
            asked = threading.Thread(target=_ask, args=(url_of(port), answered), daemon=True)
            asked.start()
        time.sleep(0.05)
    if not answered.is_set() and not listens(port):
        raise _not_started(
            f"it did not respond within {START_PATIENCE_S:g} s; check that 'rerun' opens a window"
        )


def _not_started(why: str) -> ViewerError:
    return ViewerError(f"the viewer did not start: {why}", reason=why)


def _ask(url: str, answered: threading.Event) -> None:
    """Request the state of the viewer, which only a viewer with a window returns."""
    try:
        ViewerClient.connect(url).get_state()
    except OSError:  # the viewer does not answer yet
        return
    answered.set()
