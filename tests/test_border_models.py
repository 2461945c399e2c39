"""Invalid robots: masses, inertias, joints, names, URDF files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from border import (
    CUBE,
    MODEL,
    NAN,
    Bad,
    Q,
    V,
    check,
    joint,
    law,
    link,
    massive,
    massless_leaf,
    simulation,
    urdf,
)

import onorbit_rs as oo

BAD: dict[str, Bad] = {
    # masses and inertias
    "mass zero": Bad(
        lambda: oo.Model.rigid_body(0.0, CUBE), "ModelError", ("base", "0 kg", "positive"), {"link": "base"}
    ),
    "mass negative": Bad(
        lambda: oo.Model.rigid_body(-2.5, CUBE), "ModelError", ("-2.5 kg", "positive"), {"link": "base"}
    ),
    "mass NaN": Bad(lambda: oo.Model.rigid_body(NAN, CUBE), "ModelError", ("base", "finite")),
    "a link's mass negative": Bad(lambda: link(mass=-2.0), "ModelError", ("arm", "-2 kg"), {"link": "arm"}),
    "inertia indefinite": Bad(
        lambda: oo.Model.rigid_body(1.0, np.diag([1, -1, 1])),
        "ModelError",
        ("base", "-1", "indefinite"),
        {"link": "base"},
    ),
    "inertia not symmetric": Bad(
        lambda: oo.Model.rigid_body(1.0, CUBE + np.triu(np.full((3, 3), 0.5), 1)),
        "ModelError",
        ("symmetric", "0.5"),
        {"link": "base"},
    ),
    "inertia zero": Bad(
        lambda: oo.Model.rigid_body(1.0, np.zeros((3, 3))),
        "ModelError",
        ("base", "singular", "give"),
        {"link": "base"},
    ),
    "massless leaf": Bad(
        massless_leaf,
        "ModelError",
        ("arm", "hinge", "add inertial properties"),
        {"link": "arm", "joint": "hinge"},
    ),
    "inertia without mass": Bad(lambda: link(mass=None), "ModelError", ("given without mass",)),
    # joints and names
    "no such frame": Bad(
        lambda: MODEL.frame_pose(Q, "tol"),
        "FrameError",
        ("'tol'", "did you mean 'tool'"),
        {"name": "tol", "kind": "frame", "suggestion": "tool"},
    ),
    "no such frame, none near": Bad(
        lambda: MODEL.frame_pose(Q, "xyz"), "FrameError", ("'xyz'", "torso", "tool"), {"suggestion": None}
    ),
    "no such frame for a wrench": Bad(
        lambda: MODEL.forward_dynamics(Q, V, V, external={"tooll": V[:6]}),
        "FrameError",
        ("tool",),
        {"suggestion": "tool"},
    ),
    "no such frame for a tool": Bad(
        lambda: law(tool="tools"), "FrameError", ("tool",), {"suggestion": "tool"}
    ),
    "no such frame for a run": Bad(
        lambda: simulation(tool="too"), "FrameError", ("tool",), {"suggestion": "tool"}
    ),
    "no such body for an effect": Bad(
        lambda: simulation(environment=[oo.BodyWrench("toso", force=[1, 0, 0])]),
        "FrameError",
        ("torso",),
        {"suggestion": "torso"},
    ),
    "no such parent": Bad(
        lambda: link(parent="bse"), "FrameError", ("bse", "base"), {"suggestion": "base", "kind": "link"}
    ),
    "no such kind of joint": Bad(
        lambda: link(kind="revolut"), "ModelError", ("revolut", "revolute"), {"joint": "hinge"}
    ),
    "axis zero": Bad(lambda: link(axis=[0, 0, 0]), "ModelError", ("hinge", "zero"), {"joint": "hinge"}),
    "damping negative": Bad(lambda: link(damping=-1.0), "ModelError", ("damping", "-1"), {"joint": "hinge"}),
    "rotor negative": Bad(
        lambda: link(rotor_inertia=-0.1), "ModelError", ("rotor", "-0.1"), {"joint": "hinge"}
    ),
    "limits reversed": Bad(
        lambda: link(lower=1.0, upper=-1.0), "ModelError", ("1", "-1"), {"joint": "hinge"}
    ),
    "no such robot": Bad(
        lambda: oo.robots.load("humanoid_tors"),
        "NotFoundError",
        ("humanoid_torso",),
        {"suggestion": "humanoid_torso"},
    ),
    # URDF
    "URDF empty": Bad(lambda: oo.Model.from_urdf_string(""), "ModelError", ("empty",)),
    "URDF blank": Bad(lambda: oo.Model.from_urdf_string("\n \n"), "ModelError", ("empty",)),
    "URDF not XML": Bad(lambda: oo.Model.from_urdf_string("hello"), "ModelError", ("line 1", "not XML")),
    "URDF cut off": Bad(
        lambda: oo.Model.from_urdf_string("<robot><link name='a'>"), "ModelError", ("not XML",)
    ),
    "URDF of another kind": Bad(lambda: oo.Model.from_urdf_string("<sdf/>"), "ModelError", ("sdf", "robot")),
    "URDF without links": Bad(lambda: urdf(""), "ModelError", ("no links",)),
    "URDF with a link under two joints": Bad(
        lambda: urdf(
            massive("a")
            + massive("b")
            + massive("c")
            + joint("j", "a", "b")
            + joint("k", "a", "c")
            + joint("l", "c", "b")
        ),
        "ModelError",
        ("'b'", "'j'", "'l'", "loop"),
    ),
    "URDF that is a ring": Bad(
        lambda: urdf(massive("a") + massive("b") + joint("j", "a", "b") + joint("k", "b", "a")),
        "ModelError",
        ("loop", "root"),
    ),
    "URDF with two roots": Bad(
        lambda: urdf(massive("a") + massive("b")), "ModelError", ("'a'", "'b'", "root")
    ),
    "URDF with an unknown link": Bad(
        lambda: urdf(massive("left") + joint("j", "left", "rigth") + massive("right")),
        "ModelError",
        ("rigth", "right"),
    ),
    "URDF too deep": Bad(
        lambda: oo.Model.from_urdf_string("<a>" * 100_000 + "</a>" * 100_000),
        "ModelError",
        ("nested deeper",),
    ),
    "URDF without any mass": Bad(lambda: urdf('<link name="a"/>'), "ModelError", ("mass",)),
    "URDF file missing": Bad(
        lambda: oo.Model.from_urdf("/nowhere/robot.urdf"),
        "NotFoundError",
        ("/nowhere/robot.urdf",),
        {"path": "/nowhere/robot.urdf"},
    ),
    "URDF file a folder": Bad(
        lambda: oo.Model.from_urdf(Path(__file__).parent),
        "ReadError",
        ("tests", "folder"),
        {"path": str(Path(__file__).parent)},
    ),
    "URDF file this test": Bad(
        lambda: oo.Model.from_urdf(__file__), "ModelError", (".py:1", "not XML"), {"path": __file__}
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input(name: str) -> None:
    check(BAD[name])


def test_a_builder_stays_usable_after_an_error() -> None:
    before = MODEL.mass_matrix(Q)
    for bad in BAD.values():
        with pytest.raises(oo.OnOrbitError):
            bad.call()
    np.testing.assert_array_equal(MODEL.mass_matrix(Q), before)
