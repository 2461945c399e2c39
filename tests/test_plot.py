"""Plots of any columns, and what notebooks show of models, runs and traces."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build


@pytest.fixture(scope="module")
def reach(tmp_path_factory: pytest.TempPathFactory) -> oo.Run:
    out = tmp_path_factory.mktemp("plot") / "out"
    changes = {"simulation.duration": 0.05}
    return oo.run("humanoid_reach", changes=changes, out=out, quiet=True, figures=False, recording=False)


def test_a_plot_has_the_values_units_and_names_of_joints(reach: oo.Run) -> None:
    joint = reach.model.joint_names[2]
    axes = oo.plot(reach, f"tau/{joint}").axes[0]
    assert axes.get_ylabel() == f"tau/{joint} [N m]"
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), reach.trace.tau[:, 2])


def test_wildcards_groups_and_folders_select_the_same(reach: oo.Run) -> None:
    for source in (reach, oo.read_run(reach.out)):
        for column in ("q/position", "q/posit*/*"):
            legend = oo.plot(source, column).axes[0].get_legend()
            assert [text.get_text() for text in legend.get_texts()] == ["x", "y", "z"]


def test_one_panel_per_unit_and_a_default(reach: oo.Run) -> None:
    assert [axes.get_ylabel() for axes in oo.plot(reach).axes] == ["q/position [m]", "q/joints [rad]"]
    axes = oo.plot(reach, "kinetic_energy", "v").axes
    assert [one.get_xlabel() for one in axes] == ["", "", "time [s]"]


def test_a_notebook_shows_a_plot_without_pyplot(reach: oo.Run) -> None:
    """Jupyter registers its display of figures only when pyplot is used, which this package does not."""
    png = oo.plot(reach, "tau")._repr_png_()  # type: ignore[attr-defined]
    assert png.startswith(b"\x89PNG") and 700 < int.from_bytes(png[16:20], "big") < 900, "pixels of width"


def test_a_misspelt_column_names_the_nearest(reach: oo.Run) -> None:
    with pytest.raises(oo.exceptions.InputError, match=r"'q/positon'; did you mean 'q/position'"):
        oo.plot(reach, "q/positon")
    with pytest.raises(
        oo.exceptions.InputError, match=r"'w'; names are, for example, q/position or acceleration"
    ):
        oo.plot(reach, "w")
    with pytest.raises(oo.exceptions.InputError, match=r"each column must be a name, .* 3 is of type int"):
        oo.plot(reach, 3)  # type: ignore[arg-type]
    with pytest.raises(oo.exceptions.InputError, match="source is of type int"):
        oo.plot(3)  # type: ignore[arg-type]


def test_columns_of_several_systems_share_their_label() -> None:
    run = oo.run("two_spheres", quiet=True, changes={"simulation.duration": 0.01})
    (axes,) = oo.plot(run).axes
    assert axes.get_ylabel() == "q/position [m]"
    with pytest.raises(
        oo.exceptions.InputError, match=r"'q'; names are, for example, \w+/q/position or \w+/q/position"
    ):
        oo.plot(run, "q")


def test_a_model_shows_its_tree(reach: oo.Run) -> None:
    shown = reach.model._repr_html_()
    for name in (*reach.model.joint_names, *reach.model.body_names):
        assert name in shown


def test_html_escapes_the_text_of_users() -> None:
    text = '<robot name="&lt;script&gt;"><link name="a&lt;b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>'  # noqa: E501
    shown = oo.Model.from_urdf_string(text)._repr_html_()
    assert "<script>" not in shown and "&lt;script&gt;" in shown and "a&lt;b" in shown


def test_a_run_shows_its_certificate_in_small(reach: oo.Run) -> None:
    assert repr(reach).startswith("<Run 'humanoid_reach': ") and len(repr(reach)) < 250
    assert "linear momentum drift" in reach._repr_html_() and "passed" in reach._repr_html_()


def test_a_run_shows_the_times_of_its_events() -> None:
    changes = {"simulation.duration": "91 s", "simulation.record_every": 1000}
    run = oo.run("release_and_retreat", quiet=True, changes=changes)
    event, shown = run.summary["events"][-1], run._repr_html_()
    assert event["name"] == "let_go" and event["time_s"] == 90.0
    assert ">90<" in shown[shown.index(">let_go<") :].split("</tr>")[0]


def test_a_trace_shows_itself_and_a_failure_falls_back(
    reach: oo.Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    assert reach.trace._repr_png_().startswith(b"\x89PNG")
    monkeypatch.setattr("onorbit_rs.figures.plot.lines_of", lambda _: 1 / 0)
    assert reach.trace._repr_png_() is None


def test_every_public_class_of_the_engine_has_a_repr() -> None:
    classes = [found for name in oo.__all__ if isinstance(found := getattr(oo, name), type)]
    without = {found.__name__ for found in classes if found.__repr__ is object.__repr__}
    assert not without and len(classes) > 50


def test_user_code_and_logs_have_a_repr(tmp_path: Path) -> None:
    class Damper(oo.Controller):
        def __init__(self) -> None:
            self.gain, self.history = 0.5, np.zeros(100)

        def update(self, t: float, state: object) -> np.ndarray:
            return np.zeros(7)

    assert repr(Damper()).startswith("Damper(gain=0.5, history=array(") and len(repr(Damper())) < 100
    with oo.CommandLog(tmp_path / "a.jsonl") as log:
        assert repr(log) == f"<CommandLog: 0 commands, in {tmp_path / 'a.jsonl'}>"
    assert repr(oo.CommandLog()) == "<CommandLog: 0 commands>"


def test_a_repr_has_the_arguments_or_the_numbers() -> None:
    assert repr(oo.JointHold([0.1, 0.2])) == "JointHold(q=[0.1, 0.2])"
    assert repr(oo.JointHold(np.zeros(9))) == "JointHold(q=array(9,))"
    simulation = build(load("humanoid_reach")).simulation
    assert repr(simulation).startswith("<Simulation: integrator 'rk4'")
    for shown in (simulation, oo.ModelBuilder("a", base="b", mass=1.0, inertia=np.eye(3).tolist())):
        assert "object at 0x" not in repr(shown) and len(repr(shown)) < 250
