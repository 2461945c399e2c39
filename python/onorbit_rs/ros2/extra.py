"""The optional packages of the extra ``ros2``."""

from __future__ import annotations

from importlib.util import find_spec

from onorbit_rs.exceptions import Ros2Error

HINT = "pip install 'onorbit-rs[ros2]'"


def require(*packages: str) -> None:
    """Raise an error that names the extra if one of the packages is not installed.

    Raises
    ------
    Ros2Error
        If a package is missing; the message contains the command that installs it.
    """
    missing = [name for name in packages if find_spec(name) is None]
    if missing:
        what = "it" if len(missing) == 1 else "them"
        raise Ros2Error(f"ROS messages require {' and '.join(missing)}; to install {what}, use {HINT}")
