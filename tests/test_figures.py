"""Figures show the numbers of the trace with units and do not change matplotlib's global state."""

from __future__ import annotations

import re
import subprocess
import sys
import warnings
from dataclasses import replace
from html import escape
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from mesh_files import CORNERS, stl_binary
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import onorbit_rs as oo
from onorbit_rs import figures
from onorbit_rs.common.display_units import with_prefix
from onorbit_rs.figures.style import MOST_POINTS, thin
from onorbit_rs.output.read import SavedTrace
from onorbit_rs.scenario import Scenario, load
from onorbit_rs.visuals.solids import robot_polygons


@pytest.fixture(scope="module")
def reach() -> oo.Run:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"time_step": 5e-3}
    return oo.run(data, quiet=True)


@pytest.fixture(scope="module")
def tumble() -> oo.Run:
    data = load("leo_drag_tumble").resolved()
    data["simulation"] |= {"duration": 600.0, "time_step": 1.0}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the inertia of a link
        return oo.run(data, quiet=True)


def subject(run: oo.Run, scenario: Scenario | None = None) -> figures.Subject:
    orbit = None if run.scenario.orbit is None else run.scenario.orbit.build(Path())
    return figures.subject_of(run.trace, scenario or run.scenario, run.model, orbit, None)


def labels(figure: Figure) -> list[str]:
    return [text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel()) if text]


def test_torques_equal_those_of_the_trace(reach: oo.Run) -> None:
    figure = figures.joint_torques(reach.trace, reach.model)
    (axes,) = figure.axes
    lines = [line for line in axes.lines if line.get_label() in reach.model.joint_names]
    assert [line.get_label() for line in lines] == list(reach.model.joint_names)
    drawn = np.column_stack([line.get_ydata() for line in lines])
    np.testing.assert_array_equal(drawn, reach.trace.tau)
    assert labels(figure) == ["time [s]", "torque [N m]"]


def test_errors_equal_those_of_the_trace_in_the_unit_of_the_label(reach: oo.Run) -> None:
    figure = figures.tracking_errors(reach.trace)
    factors = {"µm": 1e6, "mm": 1e3, "nm": 1e9, "m": 1.0, "µrad": 1e6, "mrad": 1e3, "nrad": 1e9, "rad": 1.0}
    for axes, error in zip(
        figure.axes, (reach.trace.position_error, reach.trace.attitude_error), strict=True
    ):
        unit = axes.get_ylabel().split("[")[1].rstrip("]")
        drawn = np.column_stack([line.get_ydata() for line in axes.lines])
        np.testing.assert_allclose(drawn[:, :3], error * factors[unit], rtol=1e-12)
        np.testing.assert_allclose(drawn[:, 3], np.linalg.norm(error, axis=1) * factors[unit], rtol=1e-12)


def test_angles_of_several_turns_are_drawn_within_half_a_turn() -> None:
    data = {
        "robot": {"rigid_body": {"mass": 10.0, "inertia": [1.0, 1.0, 2.0]}},
        "initial": {"angular_velocity": [0.0, 0.0, 1.0]},
        "simulation": {"duration": 40.0, "time_step": 0.1},
    }
    trace = oo.run(data, quiet=True).trace
    lower = figures.base_motion(trace).axes[1]
    yaw = next(line for line in lower.lines if line.get_label() == "yaw")
    time, drawn = yaw.get_data()
    shown = np.isfinite(drawn)
    assert np.sum(~shown) == 6, "40 rad pass 180 degrees six times"
    assert np.abs(drawn[shown]).max() <= 180.0 and lower.get_ylim() == (-180.0, 180.0)
    turned = np.degrees(time[shown]) - drawn[shown]
    np.testing.assert_allclose(turned / 360.0, np.round(turned / 360.0), atol=1e-9)


def test_every_axis_of_every_figure_has_a_unit(reach: oo.Run) -> None:
    trace, model = reach.trace, reach.model
    drawn = [
        figures.desired_trajectory(trace, model),
        figures.obtained_trajectory(trace),
        figures.tracking_errors(trace),
        figures.joint_torques(trace, model),
        figures.base_motion(trace),
        figures.base_reaction(trace),
        figures.ledger(trace),
        figures.manipulability(trace, model, "tool"),
    ]
    for figure in drawn:
        assert labels(figure) and all("[" in label for label in labels(figure)), labels(figure)


def test_saved_pictures_are_not_empty(reach: oo.Run, tmp_path: Path) -> None:
    names: list[str] = []
    files = figures.save_all(subject(reach), tmp_path / "figures", formats=("png", "pdf"), tell=names.append)
    assert [file.name for file in files[::2]] == [f"{name}.png" for name in names]
    assert len(names) == 8
    for png, pdf in zip(files[::2], files[1::2], strict=True):
        assert png.read_bytes().startswith(b"\x89PNG") and png.stat().st_size > 10_000
        content = pdf.read_bytes()
        assert (
            content.startswith(b"%PDF") and b"/Type3" not in content
        )  # Type 3 fonts, which publishers reject


def test_only_the_papers_run_shows_the_papers_numbers(reach: oo.Run) -> None:
    names = {drawing.name for drawing in figures.drawings(subject(reach))}
    assert {"fig4_desired_trajectory", "fig7_joint_torques"} <= names
    data = reach.scenario.resolved() | {"description": "mine"}
    assert subject(reach, load(data)).is_the_papers  # descriptions and steps do not change the experiment
    data["reference"]["displacement"] = [0.4, 0.0, 0.0]
    mine = list(figures.drawings(subject(reach, load(data))))
    assert {"desired_trajectory", "joint_torques"} <= {drawing.name for drawing in mine}
    assert not any("fig" in drawing.name or "paper" in drawing.caption for drawing in mine)


def test_equal_runs_give_equal_files(reach: oo.Run) -> None:
    for kind in ("svg", "pdf"):
        assert figures.as_bytes(figures.base_motion(reach.trace), kind) == figures.as_bytes(
            figures.base_motion(reach.trace), kind
        )


def test_figures_have_the_size_of_a_column_or_a_page(reach: oo.Run) -> None:
    for drawing in figures.drawings(subject(reach)):
        figure = drawing.draw()
        assert figure.get_figwidth() in (figures.COLUMN, figures.PAGE), drawing.name
        for axes in figure.axes:
            texts = [*axes.get_xticklabels(), *axes.get_yticklabels(), axes.xaxis.label, axes.yaxis.label]
            assert all(text.get_fontsize() >= 7 for text in texts), drawing.name


def test_manipulability_is_the_square_root_of_the_determinant(reach: oo.Run) -> None:
    figure = figures.manipulability(reach.trace, reach.model, "tool")
    pose, position = figure.axes
    q, v = reach.trace.q[0], reach.trace.v[0]
    free = np.asarray(reach.model.free_floating(q, v, "tool").jacobian)
    held = np.asarray(reach.model.frame_jacobian(q, "tool"))[:, 6:]
    for axes, rows in ((pose, 6), (position, 3)):
        for line, jacobian in zip(axes.lines, (free[:rows], held[:rows]), strict=True):
            assert line.get_ydata()[0] == pytest.approx(
                np.sqrt(np.linalg.det(jacobian @ jacobian.T)), rel=1e-9
            )


def test_the_balance_figure_shows_unexplained_changes(reach: oo.Run) -> None:
    trace = reach.trace
    columns = {name: np.array(getattr(trace, name)) for name in trace.columns()}
    assert unexplained(SavedTrace(columns)) == pytest.approx(unexplained(trace))
    assert max(unexplained(trace)) < 1e-10  # N s, N m s, J: RK4 at 5 ms
    columns["momentum"][600:, 4] += 1e-3  # must be visible
    columns["kinetic_energy"][600:] += 2e-3
    linear, angular, energy = unexplained(SavedTrace(columns))
    assert linear < 1e-11
    assert (angular, energy) == pytest.approx((1e-3, 2e-3), rel=1e-6)


def unexplained(trace: Any) -> list[float]:
    """Returns the largest value of each panel on the right, which shows what the balance does not explain."""
    return [float(np.max(axes.lines[0].get_ydata())) for axes in figures.ledger(trace).axes[1::2]]


def test_the_base_reaction_is_the_angle_of_rotation(reach: oo.Run) -> None:
    turned, rate = figures.base_reaction(reach.trace).axes
    assert turned.get_ylabel() == "rotation [deg]"
    angle = turned.lines[0].get_ydata()
    assert np.radians(angle.max()) == pytest.approx(reach.summary["base_rotation_max_rad"], rel=1e-12)
    drawn = np.column_stack([line.get_ydata() for line in rate.lines])
    np.testing.assert_allclose(np.radians(drawn), reach.trace.v[:, 3:6], rtol=1e-12)


def test_forces_equal_those_of_the_wrenches(tumble: oo.Run) -> None:
    figure = figures.environment_forces(tumble.trace, tumble.model.body_names)
    (drag,) = [axes for axes in figure.axes if axes.get_ylabel() == "drag\nforce [N]"]
    names = list(tumble.model.body_names)
    drawn = {line.get_label(): line.get_ydata() for line in drag.lines}
    for name, values in drawn.items():
        force = np.linalg.norm(tumble.trace.wrenches["drag"][:, names.index(name), :3], axis=1)
        np.testing.assert_array_equal(values, force)
    assert "drag\nforce [N]" in labels(figure) and "torque [N m]" in labels(figure)


def test_the_acceleration_removed_in_carried_mode_is_stated(tumble: oo.Run) -> None:
    def about(subject_of_run: figures.Subject) -> str:
        (drawing,) = [one for one in figures.drawings(subject_of_run) if one.name == "environment_forces"]
        return drawing.caption

    assert "carried" not in about(subject(tumble))
    assert "common acceleration due to drag and light is removed" in about(
        replace(subject(tumble), is_carried=True)
    )
    sgp4 = load("sgp4_orbit")
    orbit = sgp4.orbit.build(Path())
    subject_of_run = figures.subject_of(tumble.trace, sgp4, tumble.model, orbit, None)
    assert subject_of_run.is_carried


def test_the_ground_track_agrees_with_the_orientation_of_the_earth(tumble: oo.Run) -> None:
    earth = oo.Earth(tumble.scenario.epoch)
    world, profile = figures.ground_track(tumble.trace, earth).axes
    latitude, longitude, height = earth.geodetic(tumble.trace.time[0], tumble.trace.position_eci[0])
    lon, lat = world.lines[0].get_data()
    assert (lon[0], lat[0]) == pytest.approx((np.degrees(longitude), np.degrees(latitude)), abs=1e-9)
    assert profile.lines[0].get_ydata()[0] == pytest.approx(height / 1e3, rel=1e-9)
    assert np.nanmax(np.abs(lat)) < 36.0  # the orbit's inclination is 35 degrees, geodetic a little more


def test_a_month_of_ground_track_is_drawn_as_labelled_dots() -> None:
    earth = oo.Earth("2026-03-20 12:00:00 UTC")
    orbit = oo.Kepler(semi_major_axis=6878e3, inclination=0.9)

    class Trace:
        def __init__(self, days: float, rows: int) -> None:
            self.time = np.linspace(0.0, days * 86400.0, rows)
            self.position_eci, self.velocity_eci = orbit.state(self.time)

    def drawn(days: float, rows: int) -> tuple[list[str], list[str]]:
        trace: Any = Trace(days, rows)
        world, profile = figures.ground_track(trace, earth).axes
        legend = world.get_legend()
        assert legend is not None
        styles = [axes.lines[0].get_linestyle() for axes in (world, profile)]
        return styles, [text.get_text() for text in legend.get_texts()]

    styles, labels = drawn(30.0, 50_000)
    assert styles == ["None", "None"] and labels == ["a dot every 14.4 min", "start", "end"]
    styles, labels = drawn(4.0, 50_000)  # 50 points for each of 61 revolutions
    assert styles == ["-", "-"] and labels == ["start", "end"]
    styles, labels = drawn(0.5, 9)  # independent of the reason for sparse rows
    assert styles == ["None", "None"] and labels[0] == "a dot every 90 min"


def test_a_robot_with_meshes_is_drawn_at_the_poses_of_its_links(reach: oo.Run, tmp_path: Path) -> None:
    urdf = oo.robots.path("humanoid_torso").read_text()
    urdf = re.sub(
        r"<(box|sphere|cylinder|capsule)\b[^>]*/>", '<mesh filename="box.stl" scale="0.1 0.1 -0.1"/>', urdf
    )
    (tmp_path / "mine.urdf").write_text(urdf)
    (tmp_path / "box.stl").write_bytes(stl_binary())
    model = oo.Model.from_urdf(tmp_path / "mine.urdf")
    q = np.asarray(reach.trace.q)[[0, -1]]
    first, last = robot_polygons(model, q)
    assert len(first[0]) == 12 * len(model.visuals) and first[0].shape[1:] == (4, 3)
    for visual, row, (faces, _) in (
        (model.visuals[k], q[n], drawn) for n, drawn in enumerate((first, last)) for k in (0, -1)
    ):
        pose = np.asarray(model.frame_pose(row, visual.link)) @ np.array(visual.pose)
        corners = (CORNERS * [0.1, 0.1, -0.1]) @ pose[:3, :3].T + pose[:3, 3]
        for corner in corners:
            assert np.linalg.norm(faces.reshape(-1, 3) - corner, axis=1).min() < 1e-6
    assert np.abs(first[0] - last[0]).max() > 0.01  # the robot moves
    figure = figures.desired_trajectory(reach.trace, model)
    assert all(any(isinstance(item, Poly3DCollection) for item in axes.collections) for axes in figure.axes)


def test_errors_of_several_controllers_equal_those_of_the_trace() -> None:
    data = load("dual_arm_reach").resolved()
    data["simulation"] |= {"duration": 0.5, "time_step": 5e-3}
    run = oo.run(data, quiet=True)
    names = {drawing.name for drawing in figures.drawings(subject(run))}
    assert {"tracking_errors_left", "tracking_errors_right", "manipulability_left"} <= names
    assert "tracking_errors" not in names  # instead of those of the right arm
    position, _ = figures.control_errors(run.trace, "left", []).axes
    drawn = np.column_stack([line.get_ydata() for line in position.lines])[:, :3]
    error = np.asarray(run.trace.tracking["left"])[:, :3]
    ratio = np.abs(drawn).max() / np.abs(error).max()
    np.testing.assert_allclose(drawn, ratio * error, rtol=1e-9, atol=1e-12)


def test_names_with_special_characters_are_neither_formulas_nor_omitted(reach: oo.Run) -> None:
    names = ["$x^{", "_hidden", "<script>", "a & b", "関節", "$a$", "x" * 80]
    urdf = oo.robots.path("humanoid_torso").read_text()
    for number, name in enumerate(names, start=1):
        urdf = urdf.replace(f'"arm_joint_{number}"', f'"{escape(name)}"')
    model = oo.Model.from_urdf_string(urdf)
    assert list(model.joint_names) == names
    figure = figures.joint_torques(reach.trace, model)
    legend = figure.axes[0].get_legend()
    assert legend is not None
    figures.as_bytes(figure, "png")
    shown = [text.get_text().strip().replace(r"\$", "$") for text in legend.get_texts()]
    assert shown == [*names[:-1], "x" * 16 + "…" + "x" * 16]


def test_the_path_along_the_orbit_is_drawn(tmp_path: Path) -> None:
    data = load("kepler_orbit").resolved()
    data["simulation"] = {"duration": 600.0, "time_step": 2.0}
    result = oo.run(data, quiet=True)
    names = {file.stem for file in figures.save_all(subject(result), tmp_path)}
    assert names == {"base_motion", "base_reaction", "ledger", "orbit"}


def test_global_state_is_not_changed() -> None:
    program = (
        "import matplotlib, sys; before = matplotlib.rcParams.copy(); import onorbit_rs.figures; "
        "assert matplotlib.rcParams.copy() == before; assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", program], check=True, timeout=60)


@pytest.mark.parametrize(
    ("peak", "factor", "unit"),
    [
        (2e-5, 1e6, "µm"),
        (0.2, 1e3, "mm"),
        (1.0, 1.0, "m"),
        (999.0, 1.0, "m"),
        (2e3, 1e-3, "km"),
        (0.0, 1.0, "m"),
    ],
)
def test_prefixes(peak: float, factor: float, unit: str) -> None:
    assert with_prefix(peak, "m") == (pytest.approx(factor), unit)


def test_decimation_keeps_a_spike() -> None:
    time = np.linspace(0.0, 1.0, 10 * MOST_POINTS)
    values = np.zeros_like(time)
    values[12_345] = -7.0
    x, y = thin(time, values)
    assert len(x) <= MOST_POINTS + 2
    assert y.min() == -7.0 and x[y.argmin()] == time[12_345]


def test_a_portrait_shows_the_axes_of_the_frames_at_their_poses() -> None:
    model = oo.robots.load("humanoid_torso")
    q = model.integrate(model.neutral(), np.linspace(-0.5, 0.5, model.nv))
    figure = figures.portrait(model, q, ["tool"])
    (axes,) = figure.axes
    drawn = np.array([np.array(line.get_data_3d()).T for line in axes.lines]).reshape(2, 3, 2, 3)
    for name, (x, y, z) in zip([model.body_names[0], "tool"], drawn, strict=True):
        pose = model.frame_pose(q, name)
        np.testing.assert_allclose([x[0], y[0], z[0]], np.tile(pose[:3, 3], (3, 1)), atol=1e-12)
        tips = np.array([x[1] - x[0], y[1] - y[0], z[1] - z[0]])
        np.testing.assert_allclose(tips / np.linalg.norm(tips[0]), pose[:3, :3].T, atol=1e-12)
    assert {text.get_text() for text in axes.texts} == {model.body_names[0], "tool"}


@pytest.mark.parametrize(
    ("origin", "span"),
    [
        ([0.0, 0.0, 0.0], [0.5, 0.2, 0.3]),
        ([-12345.6, 0.0, 98765.4], [9000.0, 9000.0, 9000.0]),  # long labels
        ([-7000.0, 7000.0, -7000.0], [2e-9, 1e-9, 3e-9]),  # changes in nm
        ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]),  # flat boxes
        ([0.0, 0.0, 0.0], [0.0, 0.0, -2345.67]),
    ],
)
def test_no_label_of_a_path_is_cropped(origin: list[float], span: list[float]) -> None:
    pose = np.tile(np.eye(4), (5, 1, 1))
    pose[:, :3, 3] = np.array(origin) + np.linspace(0.0, 1.0, 5)[:, None] * span
    figure = figures.obtained_trajectory(SimpleNamespace(reference_pose=pose, tool_pose=pose))  # type: ignore[arg-type]
    figure.canvas.draw()
    (axes,) = figure.axes
    box = axes.get_tightbbox(figure.canvas.get_renderer())  # type: ignore[attr-defined]
    inside = box.transformed(figure.transFigure.inverted())
    assert inside.x0 >= 0.0 and inside.x1 <= 1.0 and inside.y0 >= 0.0, inside
    legend = figure.legends[0].get_window_extent().transformed(figure.transFigure.inverted())
    assert inside.y1 <= legend.y0, (inside, legend)


def test_both_paths_and_three_configurations_are_in_one_frame(reach: oo.Run) -> None:
    figure = figures.desired_trajectory(reach.trace, reach.model)
    (axes,) = figure.axes
    paths = {line.get_label(): np.array(line.get_data_3d()).T for line in axes.lines}  # type: ignore[attr-defined]
    np.testing.assert_array_equal(paths["desired"][-1], reach.trace.reference_pose[-1, :3, 3])
    np.testing.assert_array_equal(paths["obtained"][-1], reach.trace.tool_pose[-1, :3, 3])
    labels_shown = [text.get_text() for text in figure.legends[0].get_texts()]
    assert [label.split(",")[0] for label in labels_shown] == [
        "desired",
        "obtained",
        "start",
        "middle",
        "end",
    ]
    colors = axes.collections[0].get_facecolor()
    (one,) = robot_polygons(reach.model, np.asarray(reach.trace.q)[-1:])
    # the arm is drawn three times, the base once
    assert len(one[0]) < len(np.atleast_2d(colors)) < 3 * len(one[0])
