"""ROS 2 without an installation of ROS 2: a live node, and bags (extra ``ros2``)."""

from __future__ import annotations

from onorbit_rs.ros2.extra import require

require("rosbags", "cyclonedds")

from onorbit_rs.ros2.node import Node  # noqa: E402  # needs the packages above

__all__ = ["Node"]
