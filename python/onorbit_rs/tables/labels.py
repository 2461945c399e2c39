"""Names and units of the numbers in the columns of a trace."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs._core import COLUMNS
from onorbit_rs.output.columns import split_path

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Model

    Floats = NDArray[np.float64]

XYZ, XYZW = ("x", "y", "z"), ("x", "y", "z", "w")


@dataclass(frozen=True)
class Names:
    """Names of the joints and bodies of a robot, and the unit of each joint, ``rad`` or ``m``."""

    joints: Sequence[str] = ()
    bodies: Sequence[str] = ()
    joint_units: Sequence[str] = ()

    @classmethod
    def of(cls, model: Model) -> Names:
        """Return the names and units of a robot."""
        units = ["m" if joint.kind == "prismatic" else "rad" for joint in model.joints]
        return cls(model.joint_names, model.body_names, units)


@dataclass(frozen=True)
class Label:
    """Name of one number per row, such as ``q/position/x``, and its unit."""

    name: str
    unit: str


def labels(path: str, shape: Sequence[int], names: Names) -> list[Label]:
    """Return the labels of the numbers in a row of a column, in order.

    Parameters
    ----------
    path : str
        Path of the column in ``trace.npz``.
    shape : sequence of int
        Shape of one row.
    names : Names
        Joints and bodies of the robot.

    Returns
    -------
    list of Label
    """
    kind, _ = split_path(path)
    if not shape:
        return [Label(path, _simple_unit(kind))]
    if kind == "wrenches":
        parts = list(_parts(kind, shape[-1], names))
        bodies = names.bodies if len(names.bodies) == shape[0] else [str(k) for k in range(shape[0])]
        return [Label(f"{path}/{body}/{name}", unit) for body in bodies for name, unit in parts]
    if len(shape) == 2:
        rows, columns = (range(1, length + 1) for length in shape)
        return [Label(f"{path}/{row}{column}", _pose_unit(row, column)) for row in rows for column in columns]
    return [Label(f"{path}/{name}", unit) for name, unit in _parts(kind, shape[-1], names)]


def _parts(kind: str, width: int, names: Names) -> Iterator[tuple[str, str]]:
    """Yield the name and the unit of each number of a one-dimensional row."""
    parts: Mapping[str, tuple[slice, str]] = COLUMNS[kind].parts if kind in COLUMNS else {}
    if kind == "tracking":
        yield from _of_errors(width, names)
    elif parts:
        for part, (entries, unit) in parts.items():
            count = len(range(width)[entries])
            if part == "joints":
                yield from _of_joints("joints/", count, unit, names)
            else:
                units = unit.split(" and ") if part == "opening" else [unit] * count
                yield from zip(_axes(part, count), units, strict=True)
    elif len(names.joints) == width and width != 3:
        yield from _of_joints("", width, _simple_unit(kind), names)
    else:
        yield from ((name, _simple_unit(kind)) for name in _components(width))


def _of_errors(width: int, names: Names) -> Iterator[tuple[str, str]]:
    """Yield the name and the unit of each tracking error of a control.

    Six errors are those of a tool. Otherwise, the column does not show whether the control follows positions
    or rates, or whether a single error is that of a grip force, so that the unit names all possibilities.
    """
    if width == 6:
        yield from ((f"position/{axis}", "m") for axis in XYZ)
        yield from ((f"attitude/{axis}", "rad") for axis in XYZ)
        return
    unit = "rad, m or N; for rates, rad/s or m/s" if width == 1 else "rad or m; for rates, rad/s or m/s"
    joints = names.joints if len(names.joints) == width else [str(k) for k in range(width)]
    yield from ((joint, unit) for joint in joints)


def _of_joints(prefix: str, count: int, unit: str, names: Names) -> Iterator[tuple[str, str]]:
    """Yield the name and the unit of each joint; ``unit`` is, for example, ``N m or N``."""
    revolute, _, prismatic = unit.partition(" or ")
    joints = names.joints if len(names.joints) == count else [str(k) for k in range(count)]
    kinds = names.joint_units if len(names.joint_units) == count else [""] * count
    for joint, kind in zip(joints, kinds, strict=True):
        yield prefix + joint, {"rad": revolute, "m": prismatic or revolute}.get(kind, unit)


def _axes(part: str, count: int) -> list[str]:
    if count == 1:
        return [part]
    if part == "opening":
        return ["opening/distance", "opening/angle"]
    return [f"{part}/{axis}" for axis in _components(count)]


def _components(count: int) -> Sequence[str]:
    return {3: XYZ, 4: XYZW}.get(count, [str(k) for k in range(count)])


def _pose_unit(row: int, column: int) -> str:
    """Return the unit of an entry of a homogeneous matrix: m for the position, otherwise 1."""
    return "m" if column == 4 and row < 4 else "1"


def _simple_unit(kind: str) -> str:
    return COLUMNS[kind].unit if kind in COLUMNS else "1"


def flat(values: Any) -> Floats:
    """Return a column as a matrix (T, n) with the n numbers of each row."""
    array: Floats = np.asarray(values)
    return array.reshape(len(array), -1)
