"""The figures: drawn from the trace's own numbers, with units, without touching matplotlib's global state."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import onorbit_rs as oo
from onorbit_rs import figures
from onorbit_rs.figures.style import MOST_POINTS, thin, with_prefix
from onorbit_rs.scenario import load


@pytest.fixture(scope="module")
def reach() -> oo.Run:
    data = load("humanoid_reach").resolved()
    data["simulation"] |= {"time_step": 5e-3}
    return oo.run(data, quiet=True)


def labels(figure: Figure) -> list[str]:
    return [text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel()) if text]


def test_torques_are_those_of_the_trace(reach: oo.Run) -> None:
    figure = figures.joint_torques(reach.trace, reach.model)
    (axes,) = figure.axes
    lines = [line for line in axes.lines if line.get_label() in reach.model.joint_names]
    assert [line.get_label() for line in lines] == list(reach.model.joint_names)
    drawn = np.column_stack([line.get_ydata() for line in lines])
    np.testing.assert_array_equal(drawn, reach.trace.tau)
    assert labels(figure) == ["time [s]", "torque [N m]"]


def test_errors_are_those_of_the_trace_in_the_unit_of_the_label(reach: oo.Run) -> None:
    figure = figures.tracking_errors(reach.trace)
    factors = {"µm": 1e6, "mm": 1e3, "nm": 1e9, "m": 1.0, "µrad": 1e6, "mrad": 1e3, "nrad": 1e9, "rad": 1.0}
    for axes, error in zip(
        figure.axes, (reach.trace.position_error, reach.trace.attitude_error), strict=True
    ):
        unit = axes.get_ylabel().split("[")[1].rstrip("]")
        drawn = np.column_stack([line.get_ydata() for line in axes.lines])
        np.testing.assert_allclose(drawn[:, :3], error * factors[unit], rtol=1e-12)
        np.testing.assert_allclose(drawn[:, 3], np.linalg.norm(error, axis=1) * factors[unit], rtol=1e-12)


def test_every_axis_of_every_figure_has_a_unit(reach: oo.Run) -> None:
    trace, model = reach.trace, reach.model
    drawn = [
        figures.desired_trajectory(trace, model),
        figures.obtained_trajectory(trace),
        figures.tracking_errors(trace),
        figures.joint_torques(trace, model),
        figures.base_motion(trace),
        figures.conservation(trace),
    ]
    for figure in drawn:
        assert labels(figure) and all("[" in label for label in labels(figure)), labels(figure)


def test_saving_writes_pictures_of_some_content(reach: oo.Run, tmp_path: Path) -> None:
    files = figures.save_all(reach.trace, reach.model, tmp_path / "figures")
    assert len(files) == 6
    for file in files:
        assert file.read_bytes().startswith(b"\x89PNG")
        assert file.stat().st_size > 10_000


def test_an_orbit_flown_is_drawn(tmp_path: Path) -> None:
    data = load("kepler_orbit").resolved()
    data["simulation"] = {"duration": 600.0, "time_step": 2.0}
    result = oo.run(data, quiet=True)
    names = {file.stem for file in figures.save_all(result.trace, result.model, tmp_path)}
    assert names == {"base_motion", "conservation", "orbit"}


def test_nothing_global_is_touched() -> None:
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


def test_thinning_keeps_a_spike() -> None:
    time = np.linspace(0.0, 1.0, 10 * MOST_POINTS)
    values = np.zeros_like(time)
    values[123_456] = -7.0
    x, y = thin(time, values)
    assert len(x) <= MOST_POINTS + 2
    assert y.min() == -7.0 and x[y.argmin()] == time[123_456]
