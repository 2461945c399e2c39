"""Special cases of figures: rounding, small joints, prismatic joints, zeros, an empty map."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
from matplotlib.figure import Figure

import onorbit_rs as oo
from onorbit_rs import figures
from onorbit_rs.output.read import SavedTrace


def labels(figure: Figure) -> list[str]:
    return [text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel()) if text]


def test_rounding_errors_are_not_drawn() -> None:
    """A cannonball's radiation torque of 1e-23 N m once filled its panel."""
    force = np.full((3, 2, 6), [2e-6, 0.0, 0.0, 7e-23, 0.0, 0.0])
    gradient = np.full((3, 2, 6), [0.0, 0.0, 0.0, 0.0, 4e-6, 0.0])
    lever = np.full((3, 2, 6), [2e-6, 0.0, 0.0, 3e-13, 0.0, 0.0])  # 0.15 µm: small, but not rounding

    def said(**wrenches: Any) -> tuple[list[str], str]:
        trace: Any = SavedTrace({"time": np.arange(3.0)} | {f"wrench_{n}": w for n, w in wrenches.items()})
        figure = figures.environment_forces(trace, ["base", "hand"])
        return [" ".join(axes.get_ylabel().split()) for axes in figure.axes], figure.get_supxlabel()

    both = ["light force [N]", "gradient torque [N m]"]
    note = "zero or rounding: torque of light, force of gradient"
    assert said(light=force, gradient=gradient) == (both, note)
    assert said(light=force) == (both[:1], "zero or rounding: torque of light")
    carried = np.full((3, 2, 6), [4e-20, 0.0, 0.0, 0.0, 0.0, 0.0])  # of 1e-5 N, removed completely
    assert said(drag=carried) == ([""], "zero or rounding: force of drag, torque of drag")
    panels = ["light force [N]", "torque [N m]", "gradient torque [N m]"]
    assert said(light=lever, gradient=gradient) == (panels, "zero or rounding: force of gradient")


def test_a_tracking_error_below_rounding_is_flat() -> None:
    class Trace:
        time = np.arange(3.0)

        def __init__(self, size: float) -> None:
            self.position_error = self.attitude_error = np.outer([0.0, 1.0, -1.0], [size, 0.0, 0.0])

    def top(size: float) -> float:
        trace: Any = Trace(size)
        return figures.tracking_errors(trace).axes[0].get_ylim()[1]

    assert top(3e-16) == 1.0 and 3.0 < top(3e-12) < 4.0  # pm


def test_an_attitude_below_rounding_is_flat() -> None:
    body = {"rigid_body": {"mass": 100.0, "inertia": [10.0, 12.0, 8.0]}}
    data = {"robot": body, "orbit": {"kind": "kepler", "semi_major_axis": 7e6, "inclination": 1.7},
            "initial": {"frame": "lvlh"}, "simulation": {"duration": 3000.0, "time_step": 5.0}}  # fmt: skip

    def axis(**initial: Any) -> tuple[str, float, float]:
        trace = oo.run(data | {"initial": {"frame": "lvlh", **initial}}, quiet=True).trace
        lower = figures.orbit_overview(trace).axes[-1]
        drawn = max(float(np.abs(line.get_ydata()).max()) for line in lower.lines)
        return lower.get_ylabel().split()[-1], drawn, lower.get_ylim()[1]

    unit, drawn, top = axis()
    assert unit == "[deg]" and 0.0 < drawn < 1e-9 and top == 1.0
    unit, drawn, top = axis(angular_velocity=[0.0, 0.0, 1e-9])  # 3 µrad at the end
    assert unit == "[µdeg]" and 100.0 < drawn < top < 1.2 * drawn


def test_a_stationary_ground_track_fills_its_map() -> None:
    """The start was once hidden by the end, in the middle of an empty map."""
    earth = oo.Earth("2026-03-20 12:00:00 UTC")
    orbit = oo.Kepler(semi_major_axis=42164.17e3, inclination=0.002)

    class Trace:
        time = np.linspace(0.0, 86164.0, 500)
        position_eci, velocity_eci = orbit.state(time)

    trace: Any = Trace()
    world, _ = figures.ground_track(trace, earth).axes
    track, start, end = world.lines[:3]
    low, high = world.get_ylim()
    assert 0.5 < np.ptp(track.get_ydata()) / (high - low) < 1.0
    assert start.get_markersize() > 2.0 * end.get_markersize() and start.get_markerfacecolor() == "none"


def test_a_difference_of_one_row_is_visible_at_its_time_in_every_column() -> None:
    spin = {"robot": {"rigid_body": {"mass": 10.0, "inertia": [1.0, 2.0, 3.0]}},
            "simulation": {"duration": 1.0, "time_step": 0.1}}  # fmt: skip
    compared = oo.compare(spin, spin)
    values = np.zeros(len(compared.time))
    values[5] = 7e-12
    lone = (replace(compared.differences[0], values=values), *compared.differences[1:])
    for measured in (lone, lone[:-1]):
        panels = figures.differences(replace(compared, differences=measured)).axes[: len(measured)]
        assert [bool(axes.get_xlabel()) for axes in panels[-3:]] == [False, True, True]
        assert [axes.xaxis.get_tick_params()["labelbottom"] for axes in panels[-2:]] == [True, True]
        axes = panels[0]
        drawn = axes.transData.transform(axes.lines[0].get_xydata())  # type: ignore[arg-type]
        assert np.isfinite(drawn).all() and len(drawn) == len(values)
        low, high = axes.get_ylim()
        assert low < 7e-12 < high and drawn[4, 1] < axes.transData.transform((0.0, low))[1]


def test_errors_of_prismatic_joints_are_in_metres() -> None:
    urdf = oo.robots.path("humanoid_torso").read_text()
    turning = oo.Model.from_urdf_string(urdf)
    names = list(turning.joint_names)
    slider = re.compile(rf'(<joint name="{names[0]}" type=)"[a-z]+"')
    model = oo.Model.from_urdf_string(slider.sub(r'\1"prismatic"', urdf))
    assert [joint.kind == "prismatic" for joint in model.joints] == [True, *[False] * 6]
    errors = np.linspace(0.0, 2e-3, 7 * 5).reshape(5, 7)

    class Trace:
        time, tau = np.linspace(0.0, 1.0, 5), errors

        def __init__(self, columns: int | slice) -> None:
            self.tracking = {"posture": errors[:, columns]}

    def drawn(columns: slice, given: oo.Model | None) -> list[str]:
        trace: Any = Trace(columns)
        return labels(figures.control_errors(trace, "posture", names[columns], given))

    assert drawn(slice(0, 1), model) == ["time [s]", "joint error [mm]"]
    assert drawn(slice(1, 3), model) == ["time [s]", "joint error [mrad]"]
    assert drawn(slice(0, 7), model) == ["joint error [mrad]", "time [s]", "joint error [mm]"]
    assert drawn(slice(0, 7), turning) == ["time [s]", "joint error [mrad]"]
    assert drawn(slice(0, 7), None) == ["time [s]", "joint error [rad or m]"]
    torques: Any = Trace(slice(0, 7))
    figure = figures.joint_torques(torques, model)
    assert labels(figure) == ["torque [mN m]", "time [s]", "force [mN]"]
    assert [[line.get_label() for line in axes.lines[:-1]] for axes in figure.axes] == [names[1:], names[:1]]
    np.testing.assert_allclose(figure.axes[1].lines[0].get_ydata(), 1e3 * errors[:, 0], rtol=1e-12)


def test_of_many_joints_few_have_different_colours() -> None:
    names = [f"joint_{n}" for n in range(20)]

    class Trace:
        time = np.linspace(0.0, 1.0, 5)
        tracking: ClassVar = {"hold": np.outer(time, np.arange(20.0))}

    trace: Any = Trace()
    (axes,) = figures.control_errors(trace, "hold", names).axes
    legend = axes.get_legend()
    assert legend is not None
    names_in_legend = [text.get_text() for text in legend.get_texts()]
    assert sorted(names_in_legend) == sorted(["13 others, smaller", *names[13:]])
    colours = {line.get_color() for line in axes.lines if line.get_label() in names}
    assert len(colours) == 7
