"""The viewpoint: it shows the robot in all configurations, and the tool's path closely."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import build
from onorbit_rs.viewer.blueprint import near_path
from onorbit_rs.viewer.trace_rows import TraceRows
from onorbit_rs.viewer.viewpoint import Viewpoint

MAST = """<robot name="slider">
<link name="box"><inertial><mass value="50"/>
<inertia ixx="3" iyy="3" izz="3" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="0.6 0.6 0.6"/></geometry></visual></link>
<link name="mast"><inertial><mass value="2"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="0.1 0.1 0.5"/></geometry></visual></link>
<joint name="extend" type="prismatic"><parent link="box"/><child link="mast"/><axis xyz="0 0 1"/>
<limit lower="0" upper="3" effort="10" velocity="1"/></joint></robot>"""


def test_the_view_contains_the_robot_at_all_times() -> None:
    """The view was once fitted to the start: an extending mast left the picture."""
    model = oo.Model.from_urdf_string(MAST)
    rates = np.array([0.0, 0, 0, 0, 0, 0, 1.0])
    rows = TraceRows.of_trace(oo.Simulation(model, model.neutral(), rates, time_step=0.1).run(2.0))
    viewpoint = Viewpoint.of(rows, viewer.Setting(model))
    first = Viewpoint.of(
        TraceRows({name: values[:1] for name, values in rows.columns.items()}), viewer.Setting(model)
    )
    top = np.array([0.0, 0.0, rows["q"][-1, 7] + 0.25])
    assert np.linalg.norm(top - viewpoint.rot_fb.T @ viewpoint.center) < viewpoint.size / 2.0
    assert np.linalg.norm(top - first.rot_fb.T @ first.center) > first.size


def test_a_short_path_is_shown_closely_and_unobstructed() -> None:
    setting, rows = rows_of("humanoid_reach")
    viewpoint, middle = Viewpoint.of(rows, setting), rows["reference_pose"][:, :3, 3].mean(axis=0)
    for scale, name in ((1.0, "Tool and its path"), (0.02, "Path of the tool, without the robot")):
        pose = rows["reference_pose"].copy()
        pose[:, :3, 3] = middle + scale * (pose[:, :3, 3] - middle)
        moved = TraceRows({**rows.columns, "reference_pose": pose})
        view = near_path(moved, replace(setting, path_frame="world"), viewpoint)
        assert view is not None and view.name == name
        assert ("- /world/robot/**" in list(view.contents)) == (scale < 1.0)  # type: ignore[arg-type]
    pose[:, :3, 3] = middle
    held = TraceRows({**rows.columns, "reference_pose": pose})
    assert near_path(held, replace(setting, path_frame="world"), viewpoint) is None


def rows_of(name: str) -> tuple[viewer.Setting, TraceRows]:
    """Returns copies of all columns of a bundled scenario."""
    built = build(Scenario(**load(name).resolved() | {"simulation": {"duration": 4.0, "time_step": 0.01}}))
    columns = TraceRows.of_trace(built.simulation.run(4.0)).columns
    return viewer.Setting.of(built), TraceRows({name: values.copy() for name, values in columns.items()})


def test_the_name_of_the_tool_is_above_the_tool_and_off_the_robot() -> None:
    """It was once at the tip of the tool's z axis, which may point back along the arm."""
    setting, rows = rows_of("humanoid_reach")
    viewpoint = Viewpoint.of(rows, setting)
    pose = setting.tool_pose(rows["q"])
    center = viewpoint.rot_fb.T @ viewpoint.center
    names = {"z": np.array([0.0, 0, 0.11 * viewpoint.size]), "beside": viewpoint.beside_tool(rows, setting)}
    off, up = {}, {}
    for name, place in names.items():
        beside = pose[:, :3, 3] + pose[:, :3, :3] @ place
        off[name] = np.linalg.norm(beside - center, axis=1) - np.linalg.norm(pose[:, :3, 3] - center, axis=1)
        up[name] = beside[:, 2] - pose[:, 2, 3]
    assert off["beside"].min() > 0.05 * viewpoint.size and up["beside"].min() > 0.05 * viewpoint.size
    assert off["z"].min() < 0.0
