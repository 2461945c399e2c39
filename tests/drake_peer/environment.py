"""Python environment with Drake, separate from that of the other tests."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

DRAKE = "drake==1.51.1"
FOLDER = Path(".venv-peers")
WITHIN_S = 1200


class MissingError(Exception):
    """Raised if Drake cannot be installed here; the message gives the reason."""


def interpreter() -> Path:
    """Returns the path of the Python interpreter with Drake, which the first call installs."""
    python = FOLDER / "bin" / "python"
    if (FOLDER / ".installed").exists():
        return python
    _run([sys.executable, "-m", "venv", "--clear", str(FOLDER)])
    _run([str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", DRAKE])
    _run([str(python), "-c", "import pydrake.all"])
    (FOLDER / ".installed").touch()
    return python


def _run(command: list[str]) -> None:
    try:
        done = subprocess.run(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
            timeout=WITHIN_S,
        )
    except subprocess.TimeoutExpired:
        raise MissingError(f"{' '.join(command)} took longer than {WITHIN_S} s") from None
    if done.returncode:
        raise MissingError(f"{' '.join(command)}: {(done.stdout.strip().splitlines() or ['failed'])[-1]}")
