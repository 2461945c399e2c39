"""Helpers for the tests of bad input: a robot, invalid calls, and checks of the errors they raise."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs import exceptions

NAN, INF = float("nan"), float("inf")
MODEL = oo.robots.load("humanoid_torso")
Q, V = MODEL.neutral(), np.zeros(MODEL.nv)
CUBE = np.eye(3)


def wrist() -> oo.Model:
    """Returns a z-y-z wrist with massless links; at zero, its first and last axes coincide."""
    builder = oo.ModelBuilder("wrist", base="base", mass=10.0, inertia=np.eye(3))
    builder.add_link("a", parent="base", joint="j1", axis=[0, 0, 1])
    builder.add_link("b", parent="a", joint="j2", axis=[0, 1, 0])
    builder.add_link(
        "c", parent="b", joint="j3", axis=[0, 0, 1], mass=1.0, com=[0, 0, 0.1], inertia=np.eye(3)
    )
    return builder.build()


def with_value(index: int, value: float) -> Any:
    q = Q.copy()
    q[index] = value
    return q


def simulation(q: Any = Q, v: Any = V, **known: Any) -> oo.Simulation:
    return oo.Simulation(MODEL, q, v, **known)


def law(tool: str = "tool", **known: Any) -> oo.ComputedTorque:
    return oo.ComputedTorque(MODEL, tool, **known)


def link(**changed: Any) -> None:
    builder = oo.ModelBuilder("robot", base="base", mass=1.0, inertia=CUBE)
    known: dict[str, Any] = {"parent": "base", "joint": "hinge", "mass": 1.0, "inertia": CUBE}
    builder.add_link("arm", **(known | changed))


def urdf(body: str) -> oo.Model:
    return oo.Model.from_urdf_string(f'<robot name="r">{body}</robot>')


def massive(name: str) -> str:
    inertia = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    return f'<link name="{name}"><inertial><mass value="1"/>{inertia}</inertial></link>'


def joint(name: str, parent: str, child: str, kind: str = "continuous") -> str:
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/></joint>'


def massless_leaf() -> oo.Model:
    builder = oo.ModelBuilder("robot", base="base", mass=1.0, inertia=CUBE)
    builder.add_link("arm", parent="base", joint="hinge")
    return builder.build()


class Bad(NamedTuple):
    """An invalid call and the error it must raise: class, words of the message, fields."""

    call: Callable[[], Any]
    error: str
    words: tuple[str, ...]
    fields: dict[str, Any] = {}  # noqa: RUF012 # never written


def shape(name: str, got: Any, *words: str) -> Any:
    return ("ShapeError", (name, *words), {"name": name, "got": got})


BUILT_IN = {
    "InputError": ValueError,
    "ShapeError": ValueError,
    "DtypeError": TypeError,
    "ModelError": ValueError,
    "FrameError": KeyError,
    "OrbitError": ValueError,
    "EffectError": ValueError,
    "ControlError": ValueError,
    "NotFoundError": FileNotFoundError,
    "ReadError": OSError,
    "ScenarioError": ValueError,
}


def check(bad: Bad) -> None:
    """Checks that a call raises the error: class, built-in base class, message, fields, and pickling."""
    with pytest.raises(oo.OnOrbitError) as caught:
        bad.call()
    error = caught.value
    assert type(error) is getattr(exceptions, bad.error), (type(error), str(error))
    assert isinstance(error, BUILT_IN[bad.error])
    message = str(error)
    for word in bad.words:
        assert word in message, (word, message)
    assert "\n" not in message and not message.endswith(".") and "panicked" not in message
    for field, value in bad.fields.items():
        assert getattr(error, field) == value, (field, getattr(error, field))
    # it is pickled without loss
    copy = pickle.loads(pickle.dumps(error))
    assert type(copy) is type(error) and str(copy) == message
    for field, value in error.__dict__.items():
        same = getattr(copy, field)
        assert same == value or (same != same and value != value), field
