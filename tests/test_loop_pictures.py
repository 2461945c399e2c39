"""Closed loops in figures, in recordings and live views, in the summary and in the report."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rerun as rr
from recordings import column, rows_by_entity

import onorbit_rs as oo
from onorbit_rs import figures, viewer
from onorbit_rs.figures.loop_history import SMALLEST_OPENING
from onorbit_rs.report.numbers import groups
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build
from onorbit_rs.viewer.live import LiveView

NAMES = ["left_linkage", "right_linkage"]


@cache
def gripper() -> tuple[Any, oo.Trace]:
    """Return a run of a gripper whose linkages two loops close."""
    built = build(load("four_bar_gripper"))
    return built, built.simulation.run(1.0)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    built, trace = gripper()
    return viewer.write_recording(
        tmp_path_factory.mktemp("loops") / "run.rrd", trace, viewer.Setting.of(built)
    )


def drawings_of(trace: Any) -> dict[str, figures.Drawing]:
    return {drawing.name: drawing for drawing in figures.drawings(figures.Subject(trace))}


def test_the_figure_of_a_loop_shows_force_moment_and_opening() -> None:
    _, trace = gripper()
    found = drawings_of(trace)
    assert {f"loop_{name}" for name in NAMES} == {name for name in found if name.startswith("loop_")}
    force, moment, opening, angle = found["loop_left_linkage"].draw().axes
    loop = trace.loops["left_linkage"]
    assert force.get_ylabel() == "force [mN]"
    np.testing.assert_allclose(force.lines[2].get_ydata(), 1e3 * loop.force[:, 1], rtol=1e-12)
    np.testing.assert_allclose(
        force.lines[0].get_ydata(), 1e3 * np.linalg.norm(loop.force, axis=1), rtol=1e-12
    )
    assert moment.get_ylabel() == "moment [N m]"  # a rounding error has no prefix
    assert opening.get_yscale() == "log"
    drawn = opening.lines[0].get_ydata()
    np.testing.assert_array_equal(drawn, np.maximum(loop.opening[:, 0], SMALLEST_OPENING))
    assert angle.get_yscale() == "linear"  # always zero
    assert angle.get_xlabel() == "time [s]"


def test_a_robot_without_loops_has_no_figure_of_loops() -> None:
    built = build(load("free_tumble"))
    assert not [name for name in drawings_of(built.simulation.run(0.1)) if name.startswith("loop")]


def test_arrows_at_the_points_of_loops_have_the_scale_of_the_legend(recorded: Path) -> None:
    _, trace = gripper()
    ((text,),) = column(recorded, "/world/loops/force/scale", "Points3D:labels")
    assert text.startswith("loop force on the second frame: 1 m = ")
    value, unit = text.split()[-2:]
    scale = float(value) * {"mN": 1e-3, "N": 1.0}[unit]
    vectors = np.array(column(recorded, "/world/loops/force", "Arrows3D:vectors"))
    origins = np.array(column(recorded, "/world/loops/force", "Arrows3D:origins"))
    for index, name in enumerate(NAMES):
        loop = trace.loops[name]
        np.testing.assert_allclose(scale * vectors[:, index], loop.force, atol=1e-7)
        np.testing.assert_allclose(origins[:, index], loop.point, atol=1e-6)
    assert not np.allclose(trace.loops[NAMES[0]].point, trace.loops[NAMES[1]].point, atol=1e-3)
    moving, _ = rows_by_entity(recorded)
    assert moving["/world/loops/moment"] == 0  # pins exert no moment, except rounding errors


def test_plots_of_every_loop(recorded: Path) -> None:
    _, trace = gripper()
    moving, static = rows_by_entity(recorded)
    for name in NAMES:
        for part in ("force", "moment", "opening", "opening_angle"):
            assert moving[f"/plots/loops/{name}/{part}"] == len(trace)
            assert static[f"/plots/loops/{name}/{part}"] == 1


def test_loops_are_shown_live(tmp_path: Path) -> None:
    built = build(load("four_bar_gripper"))
    recording = rr.RecordingStream("onorbit", send_properties=False)
    recording.save(tmp_path / "live.rrd")
    live = LiveView(recording, viewer.Setting.of(built), 1.0)
    stepper = built.simulation.start()
    stepper.advance_to(0.4)
    columns = stepper.checkpoint().columns
    assert {f"loop_{name}" for name in NAMES} <= set(columns)
    live.take(columns)
    assert live.shown > 0
    stepper.advance_to(1.0)
    trace = stepper.trace()
    live.finish(trace)
    moving, _ = rows_by_entity(tmp_path / "live.rrd")
    assert moving["/plots/loops/left_linkage/force"] == len(trace)
    assert moving["/world/loops/force"] > 0


def test_the_summary_and_the_report_state_the_largest_values() -> None:
    run = oo.run("four_bar_gripper")
    summary, loop = run.summary, run.trace.loops["right_linkage"]
    assert summary["loop_right_linkage_force_max_n"] == np.linalg.norm(loop.force, axis=1).max() > 0.02
    assert summary["loop_right_linkage_opening_max_m"] == loop.opening[:, 0].max()
    rows = dict(groups(summary))["Closed loops"]
    assert len(rows) == 8
    assert [row.name for row in rows[:4]] == [
        "loop left linkage force, largest", "loop left linkage moment, largest",
        "loop left linkage opening, largest", "loop left linkage opening angle, largest",
    ]  # fmt: skip
    assert [row.unit for row in rows[:4]] == ["mN", "N m", "m", "rad"]
    plain = oo.run("parallel_gripper").summary  # mimic joints are no loops
    assert "Closed loops" not in dict(groups(plain))


def two_grasps(ends: list[Any]) -> oo.WorldTrace:
    """Return a run in which two captures connect the same two craft."""
    systems = []
    for name, x, v in (("chaser", 0.0, [0.0] * 6), ("target", 1.0, [-0.01, 0.0, 0.0, 0.02, 0.03, 0.0])):
        builder = oo.ModelBuilder(name, base="bus", mass=10.0, inertia=np.diag([0.8, 0.9, 1.0]))
        builder.add_link("arm", parent="bus", joint="hinge", xyz=[0.5 - x, 0.3, 0.0], mass=1.0,
                         inertia=np.eye(3) * 0.1)  # fmt: skip
        model = builder.build()
        q = model.neutral()
        q[0] = x
        systems.append(oo.System(name, model, q, np.array([*v, 0.1])))
    grasps = [
        oo.Capture("left", "chaser/arm", "target/arm", at=0.2),
        oo.Capture("right", "chaser/bus", "target/bus", at=0.5),
    ]
    return oo.Simulation(oo.World(systems, events=[*grasps, *ends]), time_step=0.01).run(1.0)


def test_a_capture_that_closes_a_loop_has_a_figure_and_an_open_one_has_none() -> None:
    trace = two_grasps([])
    found = drawings_of(trace["chaser"])
    assert "loop_right" in found
    assert "loop_left" not in found  # this capture joins the trees
    force = found["loop_right"].draw().axes[0].lines[0].get_ydata()
    time = np.asarray(trace["chaser"].time)
    assert not np.any(force[time < 0.5])
    assert not [name for name in drawings_of(trace["target"]) if name.startswith("loop")]
