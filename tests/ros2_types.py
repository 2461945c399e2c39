"""ROS messages declared by hand for CycloneDDS: independent of rosbags and of the package."""

from __future__ import annotations

import re
from typing import Any

from cyclonedds.idl import make_idl_struct, types

_DECLARED = """
builtin_interfaces Time: sec int32, nanosec uint32
builtin_interfaces Duration: sec int32, nanosec uint32
std_msgs Header: stamp Time, frame_id str
std_msgs Bool: data bool
std_msgs Empty: structure_needs_at_least_one_member uint8
std_msgs Float64: data float64
std_msgs String: data str
std_msgs MultiArrayDimension: label str, size uint32, stride uint32
std_msgs MultiArrayLayout: dim sequence[MultiArrayDimension], data_offset uint32
std_msgs Float64MultiArray: layout MultiArrayLayout, data floats
geometry_msgs Vector3: x float64, y float64, z float64
geometry_msgs Point: x float64, y float64, z float64
geometry_msgs Quaternion: x float64, y float64, z float64, w float64
geometry_msgs Transform: translation Vector3, rotation Quaternion
geometry_msgs TransformStamped: header Header, child_frame_id str, transform Transform
geometry_msgs Pose: position Point, orientation Quaternion
geometry_msgs PoseStamped: header Header, pose Pose
geometry_msgs PoseWithCovariance: pose Pose, covariance array[float64/36]
geometry_msgs Twist: linear Vector3, angular Vector3
geometry_msgs TwistStamped: header Header, twist Twist
geometry_msgs TwistWithCovariance: twist Twist, covariance array[float64/36]
geometry_msgs Wrench: force Vector3, torque Vector3
geometry_msgs WrenchStamped: header Header, wrench Wrench
nav_msgs Odometry: header Header, child_frame_id str, pose PoseWithCovariance, twist TwistWithCovariance
rosgraph_msgs Clock: clock Time
sensor_msgs JointState: header Header, name names, position floats, velocity floats, effort floats
tf2_msgs TFMessage: transforms sequence[TransformStamped]
trajectory_msgs JointTrajectoryPoint: positions floats, velocities floats, accelerations floats, \
effort floats, time_from_start Duration
trajectory_msgs JointTrajectory: header Header, joint_names names, points sequence[JointTrajectoryPoint]
diagnostic_msgs KeyValue: key str, value str
diagnostic_msgs DiagnosticStatus: level uint8, name str, message str, hardware_id str, \
values sequence[KeyValue]
diagnostic_msgs DiagnosticArray: header Header, status sequence[DiagnosticStatus]
rmw_dds_common Gid: data array[uint8/16]
rmw_dds_common NodeEntitiesInfo: node_namespace str256, node_name str256, \
reader_gid_seq gids, writer_gid_seq gids
rmw_dds_common ParticipantEntitiesInfo: gid Gid, node_entities_info_seq sequence[NodeEntitiesInfo]
"""

TYPES: dict[str, Any] = {}
"""Classes of the messages by their names in ROS, such as `std_msgs/msg/Header`."""

_KNOWN: dict[str, Any] = {name: getattr(types, name) for name in ("uint8", "int32", "uint32", "float64")}
_KNOWN |= {"bool": bool, "str": str, "str256": types.bounded_str[256]}
_KNOWN |= {"names": types.sequence[str], "floats": types.sequence[types.float64]}


def _type(text: str) -> Any:
    if text == "gids":
        return types.sequence[_KNOWN["Gid"]]
    if found := re.fullmatch(r"sequence\[(.*)\]", text):
        return types.sequence[_KNOWN[found[1]]]
    if found := re.fullmatch(r"array\[(.*)/(.*)\]", text):
        return types.array[_KNOWN[found[1]], int(found[2])]
    return _KNOWN[text]


for _line in _DECLARED.strip().splitlines():
    _head, _fields = _line.split(": ")
    _package, _name = _head.split()
    _members = dict(field.split() for field in _fields.split(", "))
    TYPES[f"{_package}/msg/{_name}"] = _KNOWN[_name] = make_idl_struct(
        f"{_name}_", f"{_package}.msg.dds_.{_name}_", {key: _type(text) for key, text in _members.items()}
    )
