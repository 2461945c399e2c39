"""The viewer on a screen, in a process of its own that listens to this machine alone."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def has_screen() -> bool:
    """Whether a window can be opened here."""
    on_linux = sys.platform.startswith("linux")
    return not on_linux or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def open_recording(recording: Path) -> None:
    """Open a ``.rrd`` and return at once; the viewer outlives this process."""
    command = [sys.executable, "-m", "rerun_cli", "--bind", "127.0.0.1", "--port", "auto", str(recording)]
    subprocess.Popen(command, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
