"""What notebooks show of worlds, simulations and campaigns, and the viewer below a cell."""

from __future__ import annotations

import os
import re
import sys
from html import unescape
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from campaign_files import spin

import onorbit_rs as oo
from onorbit_rs.displays.scene import recording_of


def text(html: str | None) -> str:
    assert html is not None
    return unescape(re.sub(r"(\s*<[^>]+>)+\s*", "|", html))


def world(**more: Any) -> oo.World:
    satellite, torso = oo.robots.load("small_satellite"), oo.robots.load("humanoid_torso")
    beside = satellite.neutral()
    beside[1] = 5.0
    hold = oo.Control(oo.JointComputedTorque(kp=1, kd=1), reference=oo.JointHold(np.zeros(7)), name="stay")
    systems = [
        oo.System("chaser", torso, torso.neutral(), np.zeros(torso.nv), controller=[hold]),
        oo.System("target", satellite, beside, np.zeros(6)),
    ]
    return oo.World(systems, orbit=oo.Kepler(semi_major_axis=7e6), **more)


def test_a_world_shows_its_systems_and_what_acts_on_them() -> None:
    drag = oo.Drag(oo.ConstantAtmosphere(1e-12))  # has no pickled form
    grasp = oo.Capture("grasp", "chaser/tool", "target/bus", at=2.0)
    shown = text(world(environment=[oo.GravityGradient(), drag], events=[grasp])._repr_html_())
    for part in ("|chaser|humanoid_torso|103.8 kg|7|stay: JointComputedTorque|", "|target|small_satellite|",
                 "GravityGradient; Drag", "'grasp': chaser/tool captures target/bus, at 2 s",
                 "semi-major axis 7000000"):  # fmt: skip
        assert part in shown, part
    assert "|contacts|none|" in shown and "|effects|none|" in text(world()._repr_html_())


def test_a_world_shows_its_contacts_with_their_laws() -> None:
    run = oo.run("two_spheres", changes={"simulation.duration": 0.01}, quiet=True)
    models = run.models.items()
    systems = [oo.System(name, model, run.trace[name].q[0], run.trace[name].v[0]) for name, model in models]
    first, second = run.models
    contact = oo.Contact(f"{first}/*", f"{second}/*", normal=oo.HuntCrossley(1e4, restitution=0.5, speed=0.1))
    assert "HuntCrossley" in text(oo.World(systems, contacts=[contact])._repr_html_())


def test_a_simulation_shows_its_systems_and_settings() -> None:
    both = world(environment=[oo.GravityGradient()])
    simulation = oo.Simulation(both, time_step=0.1, record_every=5)
    shown = text(simulation._repr_html_())
    for part in (
        "|chaser|humanoid_torso|103.8 kg|7|stay: JointComputedTorque|",
        "|effects|GravityGradient|",
        "|contacts|none|",
        "|engine|native|",
        "|integrator|rk4|",
        "|time step|0.1 s|",
        "every 0.5 s",
    ):
        assert part in shown, part
    assert [type(effect) for effect in simulation.environment] == [oo.GravityGradient]
    assert list(simulation.controllers) == ["chaser", "target"] and simulation.controllers["target"] == []


def test_a_simulation_returns_what_acts_on_it() -> None:
    torso = oo.robots.load("humanoid_torso")
    state = (torso.neutral(), np.zeros(torso.nv))
    drag, law = oo.Drag(oo.ConstantAtmosphere(1e-12)), oo.JointComputedTorque(kp=1, kd=1)
    hold, orbit = oo.JointHold(np.zeros(7)), oo.Kepler(semi_major_axis=7e6)
    alone = oo.Simulation(torso, *state, orbit=orbit, environment=[drag], controller=law, reference=hold)
    assert alone.environment == [drag] and alone.contacts == [] and alone.engine is None
    assert list(alone.controllers.values()) == [[law]]
    assert "|JointComputedTorque|" in text(alone._repr_html_()) and "|effects|Drag|" in text(
        alone._repr_html_()
    )
    contact = oo.Contact("chaser/*", "target/*", normal=oo.HuntCrossley(1e4, restitution=0.5, speed=0.1))
    assert "|contacts|none|" in text(alone._repr_html_())
    spheres = oo.scenario.build_world.build_world(oo.scenario.load("two_spheres")).simulation
    (found,) = spheres.contacts
    assert type(found) is type(contact) and "HuntCrossley" in text(spheres._repr_html_())
    spheres.contacts.clear()
    assert len(spheres.contacts) == 1, "the lists are copies"


def test_a_simulation_names_its_engine() -> None:
    pytest.importorskip("mujoco", reason="MuJoCo is in an extra")
    torso = oo.robots.load("humanoid_torso")
    engine = oo.engines.Mujoco(torso)
    simulation = oo.Simulation(torso, torso.neutral(), np.zeros(torso.nv), engine=engine)
    assert simulation.engine is engine
    shown = text(simulation._repr_html_())
    assert "|engine|Mujoco|" in shown and "|integrator|that of the engine|" in shown


def test_a_campaign_shows_success_results_and_failures(tmp_path: Path) -> None:
    from onorbit_rs.displays.campaign import campaign_html

    parquet = pytest.importorskip("pyarrow.parquet")
    table = oo.campaign(spin(6, success={"base_rotation_max_rad": {"at_most": 0.00725}}), quiet=True)
    turned, successes = table["base_rotation_max_rad"].to_numpy(), sum(table["success"].to_pylist())
    assert 0 < successes < 6 and successes == (turned <= 0.00725).sum()
    shown = text(campaign_html(table))
    assert f"success in {successes} of 6 cases" in shown
    largest = re.search(r"base rotation in W, largest\|rad\|[^|]+\|[^|]+\|[^|]+\|(\d+), ", shown)
    assert largest and int(largest[1]) == np.argmax(turned)
    assert "base_rotation_max_rad is " in shown, "the reason of a failure"
    parquet.write_table(table, tmp_path / "cases.parquet")
    assert campaign_html(parquet.read_table(tmp_path / "cases.parquet")) == campaign_html(table)
    assert campaign_html(table.select(["case"])) is None, "a table without the columns shows itself as text"
    assert campaign_html(table.replace_schema_metadata(None)) is None


@pytest.fixture
def notebook(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """Stands in for IPython and rerun-notebook, which are not installed here, and keeps what is displayed."""
    found = SimpleNamespace(shown=[], formatters={})

    class Formatter(dict[type, Any]):
        def for_type(self, kind: type, show: Any = None) -> Any:
            before = self.get(kind)
            if show is not None:
                self[kind] = show
            return before

    class Viewer:
        def __init__(self, **size: Any) -> None:
            self.size, self.sent = size, b""

        def send_rrd(self, content: bytes) -> None:
            self.sent += content

    found.html = Formatter()
    shell = SimpleNamespace(display_formatter=SimpleNamespace(formatters={"text/html": found.html}))
    modules = {
        "IPython": {"get_ipython": lambda: shell},
        "IPython.display": {"display": lambda *shown: found.shown.extend(shown)},
        "rerun_notebook": {"Viewer": Viewer, "ErrorWidget": object},
    }
    monkeypatch.delenv("RERUN_NOTEBOOK_ASSET", raising=False)
    for name, content in modules.items():
        module = ModuleType(name)
        vars(module).update(content)
        monkeypatch.setitem(sys.modules, name, module)
    return found


@pytest.fixture(scope="module")
def spheres() -> oo.Run:
    return oo.run("two_spheres", changes={"simulation.duration": 0.1}, quiet=True)


def test_show_sends_the_recording_of_a_run(notebook: SimpleNamespace, spheres: oo.Run) -> None:
    oo.show(spheres, height=300)
    widget = notebook.shown[-1]
    assert widget.size == {"width": "auto", "height": 300, "theme": "dark"}
    assert os.environ["RERUN_NOTEBOOK_ASSET"] == "inline", "the installed copy, which needs no connection"
    assert widget.sent.startswith(b"RRF2") and len(widget.sent) > 10_000


def test_show_keeps_the_source_of_the_viewer_that_the_user_has_chosen(
    notebook: SimpleNamespace,
    spheres: oo.Run,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("RERUN_NOTEBOOK_ASSET", "serve-local")
    oo.show(spheres)
    assert os.environ["RERUN_NOTEBOOK_ASSET"] == "serve-local"
    assert capsys.readouterr().out == ""


def test_show_reads_the_recording_of_a_folder(notebook: SimpleNamespace, tmp_path: Path) -> None:
    out = tmp_path / "run"
    run = oo.run("two_spheres", out, changes={"simulation.duration": 0.1}, quiet=True, figures=False)
    for source in (run, oo.read_run(out), out):
        oo.show(source)
        assert notebook.shown[-1].sent == (out / "run.rrd").read_bytes()
    (out / "run.rrd").unlink()
    assert recording_of(run).startswith(b"RRF2"), "a run that is still in memory needs no file"
    with pytest.raises(oo.exceptions.NotFoundError, match="there is no recording in"):
        oo.show(out)


def test_show_names_the_extra_and_refuses_what_it_cannot_show(
    monkeypatch: pytest.MonkeyPatch, spheres: oo.Run, notebook: SimpleNamespace
) -> None:
    for bad, kind in (({"width": 0}, oo.exceptions.InputError), ({"height": 2.5}, oo.exceptions.DtypeError)):
        with pytest.raises(kind, match=next(iter(bad))):
            oo.show(spheres, **bad)
    with pytest.raises(oo.exceptions.DtypeError, match="source is of type WorldTrace"):
        oo.show(spheres.trace)  # type: ignore[arg-type]
    monkeypatch.setattr(sys.modules["IPython"], "get_ipython", lambda: None)
    with pytest.raises(oo.exceptions.ViewerError, match="onorbit show DIR"):
        oo.show(spheres)
    monkeypatch.setitem(sys.modules, "rerun_notebook", None)
    with pytest.raises(oo.exceptions.ViewerError, match=re.escape("pip install 'onorbit-rs[notebooks]'")):
        oo.show(spheres)


def test_a_campaign_registers_its_display_once(notebook: SimpleNamespace) -> None:
    pa = pytest.importorskip("pyarrow")
    notebook.html[pa.Table] = lambda table: "another display"
    table = oo.campaign(spin(2), quiet=True)
    registered = notebook.html[pa.Table]
    assert "Campaign" in registered(table)
    assert registered(pa.table({"case": [1]})) == "another display"
    oo.campaign(spin(2), quiet=True)
    assert notebook.html[pa.Table] is registered
