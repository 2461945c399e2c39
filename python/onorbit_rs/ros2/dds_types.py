"""Types of ROS messages as CycloneDDS declares them, from the type store of rosbags.

Payloads are passed as bytes: the declared types only describe topics to other participants.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from cyclonedds.idl import make_idl_struct
from cyclonedds.idl import types as _types
from rosbags.interfaces import Nodetype

from onorbit_rs.ros2.messages import STORE

types: Any = _types  # its generic classes have no types

_NUMBERS = "int8 uint8 int16 uint16 int32 uint32 int64 uint64 float32 float64"
_BASE: dict[str, Any] = {
    "bool": bool, "octet": types.uint8, "byte": types.uint8, "char": types.uint8, "string": str,
    **{name: getattr(types, name) for name in _NUMBERS.split()},
}  # fmt: skip


@cache
def declared(kind: str) -> Any:
    """Return the CycloneDDS class that declares a type such as ``sensor_msgs/msg/JointState``."""
    package, folder, name = kind.split("/")
    fields = {field: _field(description) for field, description in STORE.fielddefs[kind][1]}
    return make_idl_struct(f"{name}_", f"{package}.{folder}.dds_.{name}_", fields)


def _field(description: Any) -> Any:
    kind, content = description
    if kind == Nodetype.NAME:
        return declared(content)
    if kind == Nodetype.BASE:
        name, bound = content
        return types.bounded_str[bound] if name == "string" and bound else _BASE[name]
    item, length = content
    if kind == Nodetype.ARRAY:
        return types.array[_field(item), length]
    return types.sequence[_field(item), length] if length else types.sequence[_field(item)]
