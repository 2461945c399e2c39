"""ROS 2 without an installation of ROS 2: a live node, and bags (extra ``ros2``)."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

from onorbit_rs.ros2.extra import require

if TYPE_CHECKING:
    from onorbit_rs.ros2.export import export_bag, export_mcap
    from onorbit_rs.ros2.node import Node

__all__ = ["Node", "export_bag", "export_mcap"]

_LAZY = {
    "Node": ("node", ("cyclonedds", "rosbags")),
    "export_bag": ("export", ("mcap", "rosbags")),
    "export_mcap": ("export", ("mcap", "rosbags")),
}
"""Module of each name, which is imported on first access, and the packages that it requires."""


if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        """Import and return a public name on first access; raise Ros2Error if the extra is not installed."""
        if name not in _LAZY:
            raise AttributeError(f"module 'onorbit_rs.ros2' has no attribute {name!r}")
        module, packages = _LAZY[name]
        require(*packages)
        return getattr(importlib.import_module(f"onorbit_rs.ros2.{module}"), name)
