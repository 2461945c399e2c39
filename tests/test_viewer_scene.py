"""Scene of the viewer: arrows with their scale, the Earth's orientation, meshes, targets."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mesh_files import QUADS, collada, obj, picture, stl_binary
from recordings import FrameTree, column, rows_by_entity

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.common.display_units import amount, round_up
from onorbit_rs.common.rotations import local_orbital_axes
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.scenario.build import build
from onorbit_rs.viewer.planet import to_eye
from onorbit_rs.viewer.trace_rows import TraceRows
from onorbit_rs.visuals.earth_shape import is_earth
from onorbit_rs.visuals.land import centers, land, land_fraction, world_map

EPOCH = "2026-03-20 12:00:00 UTC"
ORBIT = {"semi_major_axis": "6878 km", "inclination": "97 deg"}


def record(folder: Path, **parts: Any) -> tuple[Path, oo.Trace]:
    scenario = Scenario(**{"simulation": {"duration": 2.0, "time_step": 0.05}} | parts)
    built = build(scenario)
    trace = built.simulation.run(scenario.simulation.duration)
    return viewer.write_recording(folder / "run.rrd", trace, viewer.Setting.of(built)), trace


def test_arrows_times_their_scale_equal_the_wrenches(tmp_path: Path) -> None:
    push = {"kind": "body_wrench", "body": "base", "force": [0, 3, 0], "torque": [0, 0, 0.02], "start": 1.0}
    path, trace = record(
        tmp_path,
        robot={"rigid_body": {"mass": 50, "inertia": [4, 5, 6]}},
        environment=[push],
        simulation={"duration": 2.0, "time_step": 0.05, "record_wrenches": True},
    )
    effect = "/world/arrows/body_wrench"
    half = np.sqrt(0.12 * np.array([5 + 6 - 4, 4 + 6 - 5, 4 + 5 - 6])) / 2.0  # edges² are 6/m (Iy + Iz - Ix)
    for part, unit, columns, surface in (
        ("force", "N", slice(0, 3), half[1]),
        ("torque", "mN m", slice(3, 6), half[2]),
    ):
        ((label,),) = column(path, f"{effect}/{part}/scale", "Points3D:labels")
        text, amount = label.split(" = ")
        assert text.startswith("body wrench") and text.endswith(": 1 m") and amount.endswith(f" {unit}")
        scale = float(amount.split()[0]) * (1e-3 if unit == "mN m" else 1.0)
        arrows = np.array(column(path, f"{effect}/{part}", "Arrows3D:vectors"))[:, 0]
        np.testing.assert_allclose(arrows * scale, trace.wrenches["body_wrench"][:, 0, columns], rtol=1e-6)
        origins = np.array(column(path, f"{effect}/{part}", "Arrows3D:origins"))[:, 0]
        aside = origins - trace.center_of_mass  # outside of the box, where it is visible
        np.testing.assert_allclose(np.cross(aside, arrows), 0.0, atol=1e-6)
        acts = np.einsum("ti,ti->t", aside, arrows) > 0.0
        np.testing.assert_array_equal(acts, trace.time >= 1.0)
        np.testing.assert_allclose(np.linalg.norm(aside[acts], axis=1), surface, rtol=1e-4)
        np.testing.assert_array_equal(origins[~acts], trace.center_of_mass[~acts])
    moving, _ = rows_by_entity(path)
    assert {"/plots/body_wrench/force", "/plots/body_wrench/torque"} <= set(moving)
    ((label,),) = column(path, "/world/arrows/angular_momentum/scale", "Points3D:labels")
    scale = float(label.split(" = ")[1].split()[0]) * 1e-3
    assert label.endswith("mN m s")
    arrows = np.array(column(path, "/world/arrows/angular_momentum", "Arrows3D:vectors"))[:, 0]
    np.testing.assert_allclose(arrows * scale, trace.momentum[:, 3:], rtol=1e-6, atol=1e-12)


def test_the_plotted_torque_equals_that_of_the_arrow(tmp_path: Path) -> None:
    push = {"kind": "body_wrench", "body": "arm_link_7", "force": [0, 3, 0], "torque": [0, 0, 0.02]}
    path, trace = record(
        tmp_path,
        robot="humanoid_torso",
        environment=[push],
        simulation={"duration": 0.2, "time_step": 0.01, "record_wrenches": True},
    )
    effect = "/world/arrows/body_wrench/torque"
    ((label,),) = column(path, f"{effect}/scale", "Points3D:labels")
    amount, unit = label.split(" = ")[1].split(" ", 1)
    arrows = np.array(column(path, effect, "Arrows3D:vectors"))[:, 0]
    shown = arrows * float(amount) * {"N m": 1.0, "mN m": 1e-3}[unit]
    plotted = np.array(column(path, "/plots/body_wrench/torque", "Scalars:scalars"))
    np.testing.assert_allclose(plotted, shown, rtol=1e-6, atol=1e-6)
    alone = trace.wrenches["body_wrench"][:, :, 3:].sum(axis=1)
    assert np.abs(plotted - alone).max() > 0.1  # the lever arm contributes most


def test_momenta_of_rounding_size_have_no_arrows(tmp_path: Path) -> None:
    model = oo.robots.load("humanoid_torso")
    q, v = model.neutral(), np.zeros(model.nv)
    swing = [
        oo.BodyWrench(body, torque=sign * np.array([0, 0, 0.1]))
        for body, sign in (("torso", 1), ("arm_link_1", -1))
    ]
    trace = oo.Simulation(model, q, v, environment=swing, time_step=0.01).run(0.1)
    assert trace.kinetic_energy[-1] > 1e-6
    path = viewer.write_recording(tmp_path / "run.rrd", trace, viewer.Setting(model))
    assert not [entity for entity in rows_by_entity(path)[0] if entity.startswith("/world/arrows")]


def test_amounts_are_printed_with_prefixes() -> None:
    texts = [amount(value, "N") for value in (2e-6, 5e-4, 0.01, 1.0, 2e4, 5e-12, 10.0 * 1e-7)]
    assert texts == ["2 µN", "500 µN", "10 mN", "1 N", "20 kN", "5 pN", "1 µN"]


def test_every_number_has_a_scale() -> None:
    rounded = [round_up(value) for value in (-1.0, 0.0, 5e-324, 0.003, 7.0, 1.5e308, np.inf)]
    assert rounded == [0.0, 0.0, 5e-324, 0.005, 10.0, 1.5e308, np.inf]
    assert np.isnan(round_up(np.nan))


def test_the_map_has_land_at_the_right_places() -> None:
    area = np.cos(np.radians(centers()[0]))
    share = (land().mean(axis=1) * area).sum() / area.sum()
    assert abs(share - 0.291) < 0.01  # fraction of the Earth's surface (CIA World Factbook: 29.1 %)
    places = {(52, 21): True, (0, 25): True, (-25, 135): True, (40, -100): True, (-85, 0): True}
    places |= {
        (42, 51): False,
        (47.6, -87.7): False,
        (-1, 33): False,
    }  # Caspian Sea, lakes Superior, Victoria
    places |= {(0, -30): False, (0, -150): False, (-40, 90): False, (40, 170): False}
    for (latitude, longitude), expected in places.items():
        row, column = int(2 * (90 - latitude)), int(2 * (longitude + 180))
        assert land()[row, column] == expected, (latitude, longitude)
        share_at = land_fraction(np.array([latitude], float), np.array([longitude], float))
        assert (share_at[0] > 0.5) == expected, (latitude, longitude)
    colors = world_map(True, grid_deg=400.0)
    assert colors.shape == (360, 720, 3)
    warsaw, pacific = colors[76, 402], colors[180, 60]
    assert warsaw[1] > warsaw[2] and pacific[2] > pacific[1]  # green, blue
    inland, norway, pole, ross = (
        colors[2 * (90 - 72), 2 * (180 - 40)],
        colors[40, 420],
        colors[1, 360],
        colors[338, 10],
    )
    assert inland.min() > 200 and pole.min() > 200 and ross.min() > 200  # Greenland, sea ice, ice shelf
    assert norway[1] > norway[0]


def test_the_earth_rotates_and_night_is_opposite_to_the_sun(tmp_path: Path) -> None:
    path, trace = record(
        tmp_path,
        robot={"rigid_body": {"mass": 50, "inertia": [4, 5, 6]}},
        epoch=EPOCH,
        orbit=ORBIT,
        simulation={"duration": 3600.0, "time_step": 60.0},
    )
    tree, earth = FrameTree(path), oo.Earth(EPOCH)
    earth_axes = np.swapaxes(earth.rotation(trace.time), 1, 2)
    np.testing.assert_allclose(tree.pose("earth", "I")[:, :3, :3], earth_axes, atol=1e-6)
    sun = earth.sun(trace.time)
    to_sun = sun / np.linalg.norm(sun, axis=1, keepdims=True)
    np.testing.assert_allclose(tree.pose("sun", "I")[:, :3, 0], to_sun, atol=1e-6)
    np.testing.assert_allclose(tree.pose("sun_arrow", "I")[:, :3, 0], to_sun, atol=1e-6)
    # the Sun's arrow is visible: farther from the line of sight than all moving objects
    built = build(Scenario(robot={"rigid_body": {"mass": 50, "inertia": [4, 5, 6]}}, epoch=EPOCH, orbit=ORBIT,
                           simulation={"duration": 3600.0, "time_step": 60.0}))  # fmt: skip
    eye = to_eye(TraceRows.of_trace(trace), viewer.Setting.of(built))
    aside = tree.pose("sun_arrow", "I")[0, :3, 3]
    assert (
        np.linalg.norm(aside - (aside @ eye) * eye)
        > 1.3 * np.linalg.norm(trace.position_eci, axis=1).max() / 1e3
    )
    # noon in Greenwich: the Sun is above longitude zero within the equation of time (4 degrees)
    noon = tree.pose("earth", "I")[0, :3, :3].T @ to_sun[0]
    assert abs(np.degrees(np.arctan2(noon[1], noon[0]))) < 4.0
    for layer in range(3):
        (veil,) = column(path, f"/orbit/night/{layer}", "Mesh3D:vertex_positions", static=True)
        assert np.array(veil)[:, 0].max() < 0.06 * 6378  # in axes whose x points to the Sun
    place = np.array(column(path, "/orbit/spacecraft", "Points3D:positions"))[:, 0]
    np.testing.assert_allclose(place, trace.position_eci / 1e3, rtol=1e-6)


def test_the_earth_below_an_element_set_is_in_its_axes(tmp_path: Path) -> None:
    data = load("sgp4_orbit").resolved() | {"simulation": {"duration": 600.0, "time_step": 30.0}}
    path, trace = record(tmp_path, **data)
    earth = build(Scenario(**data)).earth
    assert earth is not None and earth.axes == "TEME" and earth.epoch is not None
    teme, gcrf = oo.Earth(earth.epoch, axes="TEME"), oo.Earth(earth.epoch)
    tree = FrameTree(path)
    earth_axes = np.swapaxes(teme.rotation(trace.time), 1, 2)
    np.testing.assert_allclose(tree.pose("earth", "I")[:, :3, :3], earth_axes, atol=1e-6)
    assert np.abs(np.swapaxes(gcrf.rotation(trace.time), 1, 2) - earth_axes).max() > 1e-3  # negative control
    sun = teme.sun(trace.time)
    to_sun = sun / np.linalg.norm(sun, axis=1, keepdims=True)
    np.testing.assert_allclose(tree.pose("sun", "I")[:, :3, 0], to_sun, atol=1e-6)


def test_a_path_in_l_far_from_the_origin_is_static_in_l(tmp_path: Path) -> None:
    data: dict[str, Any] = {
        "robot": "humanoid_torso",
        "tool": "tool",
        "orbit": ORBIT,
        "controller": {"kind": "computed_torque", "kp": 100, "kd": 20},
        "reference": {"kind": "hold", "frame": "lvlh"},
        "initial": {
            "frame": "lvlh",
            "position": [0, 10e3, 0],
            "joints": [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974],
        },
        "simulation": {"duration": 0.5, "time_step": 0.01},
    }
    path, trace = record(tmp_path, **data)
    orbit = build(Scenario(**data)).orbit
    assert orbit is not None
    rot_wl, _ = orbit.lvlh(trace.time)
    np.testing.assert_allclose(FrameTree(path).pose("L")[:, :3, :3], rot_wl, atol=1e-6)
    held = np.einsum("tji,tj->ti", rot_wl, trace.reference_pose[:, :3, 3])
    (strip,) = column(path, "/world/tool/desired/path", "LineStrips3D:strips", static=True)
    np.testing.assert_allclose(np.array(strip[0]), np.tile(held[0], (len(held), 1)), atol=2e-3)  # 32 bits
    of_base = local_orbital_axes(trace.position_eci, trace.velocity_eci)
    off = np.einsum("tji,tj->ti", of_base, trace.reference_pose[:, :3, 3]) - held
    assert np.linalg.norm(off, axis=1).min() > 5.0  # with the base's L it would be elsewhere


@pytest.mark.parametrize(
    ("mu", "expected"),
    [(3.986e14, True), (4e14, True), (oo.MU_EARTH, True), (3.2486e14, False), (None, False)],
)
def test_the_earth_is_distinguished_from_other_planets(mu: float | None, expected: bool) -> None:
    assert is_earth(mu) == expected


def test_without_an_epoch_the_earth_has_no_map(tmp_path: Path) -> None:
    path, _ = record(tmp_path, robot={"rigid_body": {"mass": 50, "inertia": [4, 5, 6]}}, orbit=ORBIT)
    _, static = rows_by_entity(path)
    assert "/orbit/planet" in static
    assert not [entity for entity in static if entity.startswith(("/orbit/night", "/orbit/sun"))]


def robot_with_meshes(folder: Path, *names: str) -> oo.Model:
    visuals = "".join(
        f'<visual><geometry><mesh filename="package://craft/{name}" scale="2 2 2"/></geometry>'
        '<material name="gold"/></visual>'
        for name in names
    )
    urdf = folder / "craft.urdf"
    urdf.write_text(
        '<robot name="craft"><material name="gold"><color rgba="0.8 0.6 0.2 1"/></material><link name="bus">'
        '<inertial><mass value="6"/><inertia ixx="5" iyy="5" izz="5" ixy="0" ixz="0" iyz="0"/></inertial>'
        f"{visuals}</link></robot>"
    )
    return oo.Model.from_urdf(urdf)


def write_meshes(folder: Path) -> None:
    folder.mkdir()
    (folder / "a.stl").write_bytes(stl_binary())
    (folder / "b.obj").write_text(obj(QUADS))
    (folder / "c.DAE").write_text(
        collada(asset='<unit name="millimeter" meter="0.001"/>', texture="picture.png")
    )
    (folder / "picture.png").write_bytes(picture(*4 * [(255, 128, 0)]))
    (folder / "d.3ds").write_bytes(b"?")


def test_meshes_are_in_the_recording_with_their_unit_and_the_colour_of_the_robot(tmp_path: Path) -> None:
    write_meshes(tmp_path / "craft")
    model = robot_with_meshes(tmp_path, "a.stl", "b.obj", "c.DAE", "d.3ds")
    trace = oo.Simulation(model, model.neutral(), np.zeros(6), time_step=0.1).run(0.1)
    with pytest.warns(
        UserWarning, match=r"link 'bus' is not drawn: .*d\.3ds cannot be read: its format is not supported"
    ):
        path = viewer.write_recording(tmp_path / "run.rrd", trace, viewer.Setting(model))
    for index, size in enumerate((2.0, 2.0, 2e-3)):
        entity = f"/world/robot/bus/visual_{index}"
        (points,) = column(path, entity, "Mesh3D:vertex_positions", static=True)
        (faces,) = column(path, entity, "Mesh3D:triangle_indices", static=True)
        assert len(faces) == 12
        np.testing.assert_allclose(np.max(points, axis=0), np.array([1, 2, 3]) * size, rtol=1e-6)
        assert column(path, entity, "Mesh3D:albedo_factor", static=True) == [[0xCC9933FF]]
    (pixels,) = column(path, "/world/robot/bus/visual_2", "Mesh3D:albedo_texture_buffer", static=True)
    assert bytes(pixels[0]) == bytes([255, 128, 0] * 4)
    assert "/world/robot/bus/visual_3" not in rows_by_entity(path)[1]


def test_parts_of_a_mesh_move_with_their_link(tmp_path: Path) -> None:
    """A part with a texture is a separate entity; without a frame it would stay at the origin."""
    (tmp_path / "craft").mkdir()
    (tmp_path / "craft" / "picture.png").write_bytes(picture(*4 * [(255, 128, 0)]))
    points = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\n"
    both = f"{points}usemtl a\nf 1 2 3\nusemtl b\nf 1/1 2/1 4/1\n"
    (tmp_path / "craft" / "two.obj").write_text(both)
    (tmp_path / "craft" / "m.mtl").write_text("newmtl a\nKd 1 0 0\nnewmtl b\nmap_Kd picture.png\n")
    model = robot_with_meshes(tmp_path, "two.obj")
    trace = oo.Simulation(model, model.neutral(), np.zeros(6), time_step=0.1).run(0.1)
    path = viewer.write_recording(tmp_path / "run.rrd", trace, viewer.Setting(model))
    frames = [
        column(path, f"/world/robot/bus/visual_0{part}", "CoordinateFrame:frame", static=True)
        for part in ("", "/part_1")
    ]
    assert frames[0] == frames[1] == [["robot/bus"]]


def test_a_missing_mesh_causes_a_warning_and_a_box(tmp_path: Path) -> None:
    with pytest.warns(UserWarning, match="not found"):
        model = robot_with_meshes(tmp_path, "gone.stl")
    (box,) = viewer.Setting(model).shapes
    assert (box.kind, box.link) == ("box", "bus")
    np.testing.assert_allclose(box.size, np.sqrt(5.0))  # I = m a² / 6
    trace = oo.Simulation(model, model.neutral(), np.zeros(6), time_step=0.1).run(0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        path = viewer.write_recording(tmp_path / "run.rrd", trace, viewer.Setting(model))
    assert column(path, "/world/robot/bus/visual_0", "Boxes3D:half_sizes", static=True)


def test_a_target_drifts_and_spins(tmp_path: Path) -> None:
    motion = {"position": [0.5, 0, 0.9], "velocity": [0.1, 0, 0], "spin": [0, 0, 0.5], "size": [1, 2, 3]}
    path, trace = record(
        tmp_path,
        robot="humanoid_torso",
        tool="tool",
        controller={"kind": "computed_torque", "kp": 100, "kd": 20},
        reference={"kind": "hold", "frame": {"target": motion}},
        initial={"joints": [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]},
        simulation={"duration": 0.2, "time_step": 0.01},
    )
    pose = FrameTree(path).pose("target/0")
    np.testing.assert_allclose(pose[-1, :3, 3], [0.5 + 0.1 * trace.time[-1], 0, 0.9], atol=1e-6)
    turned = np.arctan2(pose[:, 1, 0], pose[:, 0, 0])
    np.testing.assert_allclose(turned, 0.5 * trace.time, atol=1e-6)
    assert column(path, "/world/target/0", "Boxes3D:half_sizes", static=True) == [[[0.5, 1.0, 1.5]]]
    # objects in the target's frame move with it
    held = np.linalg.inv(pose) @ trace.reference_pose
    np.testing.assert_allclose(held, np.tile(held[0], (len(held), 1, 1)), atol=1e-6)
