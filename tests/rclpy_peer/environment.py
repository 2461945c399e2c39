"""Python environment with rclpy of ROS 2 Jazzy, installed from wheels."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

FOLDER = Path(".venv-ros2")
PACKAGES = [
    "ros-jazzy-rclpy", "ros-jazzy-rmw-fastrtps-cpp", "ros-jazzy-sensor-msgs", "ros-jazzy-trajectory-msgs",
    "ros-jazzy-nav-msgs", "numpy",
]  # fmt: skip
HERE = Path(__file__).parent


class MissingError(Exception):
    """Raised if rclpy cannot be installed here; the message gives the reason."""


def interpreter() -> Path:
    """Returns the path of the Python interpreter with rclpy, which the first call installs."""
    python = FOLDER / "bin" / "python"
    if (FOLDER / ".installed").exists():
        return python
    base = sys.executable if sys.version_info[:2] == (3, 11) else shutil.which("python3.11")
    if base is None:
        raise MissingError("the wheels of rclpy need Python 3.11, which is not installed")
    _run([base, "-m", "venv", "--clear", str(FOLDER)])
    _run([str(python), "-m", "pip", "install", "--quiet", *PACKAGES])
    _run([str(python), "-c", "import rclpy"])
    (FOLDER / ".installed").touch()
    return python


def _run(command: list[str]) -> None:
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode:
        raise MissingError(f"{' '.join(command)}: {done.stdout.strip().splitlines()[-1]}")


def variables(domain: int, logs: Path) -> dict[str, str]:
    """Returns the environment variables of a node that only this machine can reach."""
    return {
        "HOME": os.environ.get("HOME", "/tmp"), "PATH": os.environ.get("PATH", ""),
        "ROS_DOMAIN_ID": str(domain),
        "ROS_LOG_DIR": str(logs), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "FASTRTPS_DEFAULT_PROFILES_FILE": str(HERE.resolve() / "loopback.xml"),
    }  # fmt: skip
