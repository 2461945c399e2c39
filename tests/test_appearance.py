"""Appearance of robots whose mesh files are missing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from recordings import column, rows_by_entity

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.visuals.shapes import missing_meshes, shapes

LENGTH = 0.5


def arm(*, visual: str = "", collision: str = "", joints: int = 3) -> oo.Model:
    """Returns a chain along x; all links except the base have the same appearance."""
    inertial = (
        '<inertial><origin xyz="0.25 0 0"/><mass value="2"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    text = f'<link name="bus">{inertial}{visual.replace("NAME", "bus")}</link>'
    for index in range(1, joints + 1):
        name, parent = f"link_{index}", "bus" if index == 1 else f"link_{index - 1}"
        text += (
            f'<link name="{name}">{inertial}{visual.replace("NAME", name)}{collision}</link>'
            f'<joint name="joint_{index}" type="continuous"><parent link="{parent}"/><child link="{name}"/>'
            f'<origin xyz="{LENGTH} 0 0.1"/><axis xyz="0 0 1"/></joint>'
        )
    return oo.Model.from_urdf_string(f'<robot name="arm">{text}</robot>')


MESH = '<visual><geometry><mesh filename="package://gone/NAME.stl"/></geometry></visual>'
TUBE = (
    '<collision><origin xyz="0.25 0 0" rpy="0 1.5708 0"/>'
    '<geometry><cylinder radius="0.05" length="0.5"/></geometry></collision>'
)
HULL = '<collision><geometry><mesh filename="package://gone/hull.stl"/></geometry></collision>'


def test_a_stick_figure_connects_the_joints() -> None:
    with pytest.warns(UserWarning, match="4 mesh files were not found"):
        model = arm(visual=MESH, collision=HULL)
    drawn = shapes(model)
    balls = {shape.link for shape in drawn if shape.kind == "sphere"}
    assert balls == {"link_1", "link_2", "link_3"}
    assert [shape.link for shape in drawn if shape.kind == "box"] == ["bus"]  # of its inertia
    rods = {shape.link: shape for shape in drawn if shape.kind == "cylinder"}
    assert set(rods) == set(model.body_names)
    q = model.neutral()
    q[7:] = [0.4, -0.9, 0.3]
    for parent, child in zip(model.body_names, model.body_names[1:], strict=False):
        rod = rods[parent]
        pose = model.frame_pose(q, parent) @ rod.pose
        ends = [pose[:3, 3] + sign * rod.size[1] / 2.0 * pose[:3, 2] for sign in (-1, 1)]
        expected = [model.frame_pose(q, link)[:3, 3] for link in (parent, child)]
        np.testing.assert_allclose(ends, expected, atol=1e-12)
    last = rods["link_3"]
    np.testing.assert_allclose(
        last.pose[:3, 3] + last.size[1] / 2.0 * last.pose[:3, 2], [0.25, 0, 0], atol=1e-12
    )


def test_collision_shapes_replace_missing_meshes() -> None:
    with pytest.warns(UserWarning, match="not found"):
        model = arm(visual=MESH, collision=TUBE + HULL)
    tubes = [shape for shape in shapes(model) if shape.size == (0.05, 0.5)]
    assert [shape.link for shape in tubes] == ["link_1", "link_2", "link_3"]
    np.testing.assert_allclose(tubes[0].pose[:3, 3], [0.25, 0, 0])
    assert not [shape for shape in shapes(model) if shape.kind == "sphere"]


def test_collision_shapes_are_not_drawn_if_visual_shapes_exist() -> None:
    ball = '<visual><geometry><sphere radius="0.1"/></geometry></visual>'
    model = arm(visual=ball, collision=TUBE)
    assert len(model.collisions) == 3
    assert {shape.kind for shape in shapes(model)} == {"sphere"} and not missing_meshes(model)


def test_a_robot_without_visual_shapes_is_a_stick_figure_too() -> None:
    assert [shape.kind for shape in shapes(arm())].count("sphere") == 3


def test_the_notes_name_the_missing_meshes(tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match="not found"):
        model = arm(visual=MESH, joints=12)
    assert missing_meshes(model)[0] == "package://gone/bus.stl" and len(missing_meshes(model)) == 13
    trace = oo.Simulation(model, model.neutral(), np.zeros(model.nv), time_step=0.1).run(0.1)
    path = viewer.write_recording(tmp_path / "run.rrd", trace, viewer.Setting(model))
    ((text,),) = column(path, "/notes", "TextDocument:text", static=True)
    assert "package://gone/bus.stl" in text and "package://gone/link_9.stl and 3 more." in text
    drawn = [entity for entity in rows_by_entity(path)[1] if entity.startswith("/world/robot/link_2/visual")]
    assert len(drawn) == 2  # a sphere and a rod
