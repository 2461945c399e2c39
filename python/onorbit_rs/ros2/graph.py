"""Announcement of a node to the ROS graph, in which ``ros2 node list`` and ``ros2 node info`` find it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from onorbit_rs.ros2.messages import encode, message

TOPIC, KIND = "ros_discovery_info", "rmw_dds_common/msg/ParticipantEntitiesInfo"

ENCLAVE = b"enclave=/;"
"""User data that marks a DDS participant as one of ROS."""


def entities_message(node: str, participant: Any, writers: Iterable[Any], readers: Iterable[Any]) -> bytes:
    """Return the message by which ROS learns that writers and readers of a participant form a node."""
    own = message(
        "rmw_dds_common/msg/NodeEntitiesInfo", node_namespace="/", node_name=node,
        reader_gid_seq=[_gid(entity) for entity in readers],
        writer_gid_seq=[_gid(entity) for entity in writers],
    )  # fmt: skip
    return encode(message(KIND, gid=_gid(participant), node_entities_info_seq=[own]))


def _gid(entity: Any) -> Any:
    return message("rmw_dds_common/msg/Gid", data=np.frombuffer(entity.get_guid().bytes, np.uint8))
