"""Plots are readable: suitable units, two ticks, one colour per line, no rounding errors shown as signals."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from recordings import column

import onorbit_rs as oo
from onorbit_rs import viewer
from onorbit_rs.viewer.plots import with_two_ticks
from onorbit_rs.viewer.series import Series, series_of
from onorbit_rs.viewer.trace_rows import TraceRows

Floats = NDArray[np.float64]


def test_units_fit_the_plotted_values() -> None:
    setting, rows = drifting()
    for size, unit in ((0.5, "N m"), (2e-6, "µN m"), (3e-11, "pN m"), (3e4, "kN m")):
        rows.columns["tau"][:] = size * np.linspace(-1.0, 1.0, len(rows))[:, None]  # type: ignore[index]
        torque = plots(rows, setting)["plots/joint_torque"]
        assert torque.unit == unit
        assert 0.5 <= np.abs(torque.values).max() < 1000.0
        live = {plot.path: plot for plot in series_of(rows, setting, is_live=True)}["plots/joint_torque"]
        assert live.unit == "N m" and np.abs(live.values).max() == size  # later values are not known yet


def test_rounding_errors_are_not_plotted() -> None:
    setting, rows = drifting()
    rows.columns["tau"][:] = 1e-13 * np.linspace(-1.0, 1.0, len(rows))[:, None]  # type: ignore[index]
    torque = plots(rows, setting)["plots/joint_torque"]
    assert torque.unit == "N m" and not torque.values.any()
    shares = np.zeros((len(rows), len(setting.model.bodies), 6))
    shares[:, 0, 0], shares[:, 1, 0] = 3e-6, -3e-6 + 2e-20  # drag on a robot in carried mode
    found = plots(replace(rows, wrenches={"drag": shares}), setting)
    assert "plots/drag/force" not in found and found["plots/drag/torque"].unit.endswith("N m")
    shares[:, 0, 0] *= 2.0
    assert plots(replace(rows, wrenches={"drag": shares}), setting)["plots/drag/force"].unit == "µN"


@pytest.mark.parametrize(
    ("low", "high"),
    [(-3.7, 3.8), (-0.75, 0.79), (-8.0, 7.0), (-700.0, 50.0), (0.0, 7.0), (51.2, 58.4), (-1e-4, 9.0)],
)
def test_a_plot_has_two_tick_labels(low: float, high: float) -> None:
    found = with_two_ticks(np.array([[low, high]]))
    assert found is not None
    bottom, top = found
    assert bottom < low and top > high
    step = 10.0 ** np.ceil(np.log10((top - bottom) / 7.0))
    assert np.floor(top / step) - np.ceil(bottom / step) >= 1.0
    assert high - low > 0.3 * (top - bottom)


def test_a_plot_with_tick_labels_is_not_changed() -> None:
    for low, high in ((-2.5, 2.5), (0.0, 11.0), (0.0, 0.0), (-10.0, 10.0), (99.0, 103.0)):
        assert with_two_ticks(np.array([[low, high]])) is None
    assert with_two_ticks(np.zeros((0, 3))) is None


def test_every_line_has_a_different_colour(tmp_path: Path) -> None:
    model = oo.Model.from_urdf_string(chain_of(33))
    rates = np.append(np.zeros(6), np.arange(33) % 20 / 20.0)
    trace = oo.Simulation(model, model.neutral(), rates, time_step=0.01).run(0.05)
    path = viewer.write_recording(tmp_path / "run.rrd", trace, viewer.Setting(model))
    (names,) = column(path, "/plots/joint_rate", "SeriesLines:names", static=True)
    (colors,) = column(path, "/plots/joint_rate", "SeriesLines:colors", static=True)
    assert len(names) == len(colors) == 33
    kept = [name for name in names if name != "others, smaller"]
    assert len(kept) == 8 and {"j19", "j18", "j17"} <= set(kept)
    assert len(set(zip(names, colors, strict=True))) == len(set(colors)) == 9
    rate = column(path, "/plots/joint_rate", "Scalars:scalars")
    np.testing.assert_array_equal(rate, trace.v[:, 6:])  # all lines are present


def test_errors_of_a_tool_are_under_its_name() -> None:
    setting, rows = drifting()
    errors = np.linspace(0.0, 1.0, 3 * len(rows)).reshape(-1, 3)
    tracked = TraceRows({**rows.columns, "position_error": errors, "attitude_error": errors})
    found = plots(tracked, replace(setting, tool="right_tool"))
    assert found["plots/tool_position_error"].title == "right_tool: position error"
    assert found["plots/tool_attitude_error"].unit == "rad"


def drifting() -> tuple[viewer.Setting, TraceRows]:
    """Returns a robot with unactuated joints and writable columns."""
    model = oo.Model.from_urdf_string(chain_of(2))
    trace = oo.Simulation(model, model.neutral(), np.full(8, 0.1), time_step=0.1).run(1.0)
    return viewer.Setting(model), TraceRows(
        {name: rows.copy() for name, rows in TraceRows.of_trace(trace).columns.items()}
    )


def plots(rows: TraceRows, setting: viewer.Setting) -> dict[str, Series]:
    return {plot.path: plot for plot in series_of(rows, setting)}


def chain_of(count: int) -> str:
    inertial = (
        '<inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    links = "".join(f'<link name="l{index}">{inertial}</link>' for index in range(count + 1))
    joints = "".join(
        f'<joint name="j{index}" type="continuous"><parent link="l{index}"/><child link="l{index + 1}"/>'
        '<origin xyz="0 0 1"/><axis xyz="0 1 0"/></joint>'
        for index in range(count)
    )
    return f'<robot name="chain">{links}{joints}</robot>'
