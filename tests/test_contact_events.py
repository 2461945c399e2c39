"""Touch-downs and lift-offs of contacts: records, resumed runs, files, and where they are shown."""

from __future__ import annotations

import json
import pickle
import signal
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import yaml
from contact_worlds import HARD, moving, pair, run
from recordings import column
from test_output_checkpoint import stopped_run

import onorbit_rs as oo
from onorbit_rs import figures
from onorbit_rs.cli import main
from onorbit_rs.exceptions import CheckpointError, InputError
from onorbit_rs.output.latches import _parting
from onorbit_rs.output.read import SavedRun
from onorbit_rs.ros2.events import message_of_event
from onorbit_rs.ros2.publisher import Publisher

ROUGH = oo.Friction(0.4, 0.3)

BOUNCING = """\
systems:
  walls: {robot: ball, initial: {position: [-21 cm, 0, 0], linear_velocity: [0, 0, 0]}}
  b: {robot: ball, initial: {linear_velocity: [-20 cm/s, 0, 0]}}
  other: {robot: ball, initial: {position: [45 cm, 0, 0], linear_velocity: [-60 cm/s, 0, 0]}}
contacts:
  - {name: near, between: [walls/body, b/body], normal: {kind: hunt_crossley, stiffness: 1e6, restitution: 0.8, speed: 20 cm/s}}
  - {name: far, between: [b/body, other/body], normal: {kind: spring_dashpot, stiffness: 1e5, damping: 20}}
  - {name: watched, between: [walls/body, other/body]}
simulation: {duration: 1.5 s, time_step: 5 ms}
"""  # noqa: E501


def kinds(trace: Any) -> list[tuple[str, str]]:
    return [(event.name, event.kind) for event in trace.events]


@pytest.fixture(scope="module")
def bounced(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Returns a run with several touches of two contacts, and its folder."""
    folder = tmp_path_factory.mktemp("bounced")
    (folder / "bouncing.yaml").write_text(BOUNCING)
    return oo.run(folder / "bouncing.yaml", folder / "run", quiet=True)


def test_an_impact_has_a_touch_down_and_a_lift_off() -> None:
    trace = run(pair(beside=0.1, friction=ROUGH))
    assert kinds(trace) == [("touch", "touch_down"), ("touch", "lift_off")]
    down, up = trace.events
    assert down.time == pytest.approx(0.02 / 0.2, rel=0.3) and down.time < up.time
    assert not down.impulse.any() and down.energy_lost == 0.0 and down.peak_force is None
    assert down.systems == up.systems == ("a", "b")
    change = trace["b"].momentum[-1] - trace["b"].momentum[0]
    np.testing.assert_allclose(up.impulse[:3], change[:3], rtol=1e-12, atol=1e-15)
    centers = trace["b"].center_of_mass[[0, -1]] - up.point
    about = [h[3:] + np.cross(c, h[:3]) for h, c in zip(trace["b"].momentum[[0, -1]], centers, strict=True)]
    np.testing.assert_allclose(up.impulse[3:], about[1] - about[0], atol=1e-14)
    touch = trace.contacts["touch"]
    assert up.energy_lost == pytest.approx(touch.dissipated[-1], rel=1e-12)
    assert up.energy_lost == pytest.approx(trace.kinetic_energy[0] - trace.kinetic_energy[-1], rel=1e-8)
    normal = np.einsum("ti,ti->t", touch.force, touch.normal)
    assert 1.0 <= up.peak_force / normal.max() < 1.0 + 1e-4
    np.testing.assert_array_equal(touch.impulse[-1], up.impulse[:3])
    assert (touch.touches[0], touch.touches[-1], touch.largest_force[-1]) == (0.0, 1.0, up.peak_force)
    assert "lift_off 'touch' of a and b" in repr(up) and "touch_down 'touch' of a and b" in repr(down)


def test_the_certificate_has_no_checks_of_contacts() -> None:
    trace = run(pair())
    assert trace.events and all(name.startswith("a+b/") for name, *_ in trace.certificate())


def test_a_capture_ends_the_touch() -> None:
    systems = [moving("a", [0, 0, 0], [0.2, 0, 0]), moving("b", [0.205, 0, 0], [0, 0, 0])]
    contact = oo.Contact("a/body", "b/body", normal=oo.HuntCrossley(1e4), name="touch")
    grasp = oo.Capture("grasp", "a/body", "b/body", at=0.04)
    trace = run(oo.World(systems, contacts=[contact], events=[grasp]))
    assert kinds(trace) == [("touch", "touch_down"), ("grasp", "capture"), ("touch", "lift_off")]
    _, capture, up = trace.events
    assert capture.time == up.time == 0.04
    both = up.impulse[:3] + capture.impulse[:3]
    np.testing.assert_allclose(both, trace["b"].momentum[-1, :3], rtol=1e-12, atol=1e-15)
    before = trace["b"].momentum[np.flatnonzero(trace["b"].time == 0.04)[0], :3]
    np.testing.assert_allclose(up.impulse[:3], before, rtol=1e-12, atol=1e-15)


def bouncing() -> oo.Simulation:
    """Returns a simulation of three balls with at least three touches of two contacts, and a fourth ball."""
    systems = [
        moving("a", [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        moving("alone", [0.0, 3.0, 0.0], [0.1, 0.0, 0.0]),
        moving("b", [0.21, 0.02, 0.0], [-0.2, 0.0, 0.0], [0.0, 1.0, 0.0]),
        moving("c", [0.5, 0.02, 0.0], [-0.8, 0.0, 0.0]),
    ]
    contacts = [
        oo.Contact("a/body", "b/body", normal=HARD, friction=ROUGH, name="near"),
        oo.Contact("b/body", "c/body", normal=oo.SpringDashpot(1e5, 20.0), name="far"),
    ]
    return oo.Simulation(oo.World(systems, contacts=contacts), time_step=5e-3)


@pytest.mark.parametrize("stop", [0.3, 0.06, 0.0612345, 0.9])
def test_a_resumed_run_has_the_same_records(stop: float) -> None:
    whole: Any = bouncing().run(1.4)
    assert len(whole.events) >= 6 and len({event.name for event in whole.events}) == 2
    stepper = bouncing().start(duration=1.4)
    stepper.advance_to(stop)
    given = stepper.checkpoint()
    checkpoint = oo.Checkpoint(given.state, given.columns)
    before = list(stepper.events)
    stepper.trace()
    assert list(stepper.events) == before == whole.events[: len(before)]
    resumed = bouncing().start(resume=checkpoint)
    assert resumed.events == before
    for other in (stepper, resumed):
        for t in np.linspace(stop, 1.4, 37):
            other.advance_to(t)
            assert other.events == whole.events[: len(other.events)]
        assert other.finish().events == whole.events


def test_a_killed_run_resumes_with_the_same_records(tmp_path: Path) -> None:
    values = yaml.safe_load(BOUNCING)
    values["simulation"] |= {"time_step": 2e-5, "record_every": 100}
    out = stopped_run(tmp_path, values, signal.SIGKILL)
    again, whole = oo.resume(out, quiet=True), oo.run(values, quiet=True)
    assert len(whole.trace.events) >= 6
    assert again.trace.events == whole.trace.events == SavedRun(out).world_trace().events
    assert again.summary["contacts"] == whole.summary["contacts"]


def test_a_checkpoint_of_other_contacts_is_refused() -> None:
    simulation = bouncing()
    stepper = simulation.start(duration=1.4)
    stepper.advance_to(0.06)
    given = stepper.checkpoint()
    state = json.loads(given.state)
    group = next(group for group in state["groups"] if group["progress"]["world"].get("touches"))
    for change in ({"touches": []}, {"contacts": []}):
        kept = {name: group["progress"]["world"][name] for name in change}
        group["progress"]["world"] |= change
        with pytest.raises(CheckpointError, match="contacts"):
            simulation.start(resume=oo.Checkpoint(json.dumps(state), given.columns))
        group["progress"]["world"] |= kept
    group["progress"]["world"]["touches"][0]["systems"] = [0, 9]
    with pytest.raises(CheckpointError, match="does not belong to systems"):
        simulation.start(resume=oo.Checkpoint(json.dumps(state), given.columns))


@pytest.mark.parametrize("integrator", ["rk4", "dormand_prince"])
def test_events_do_not_depend_on_the_rows(integrator: Any) -> None:
    def events(every: int) -> list[oo.EventRecord]:
        trace: Any = oo.Simulation(
            pair(friction=ROUGH, beside=0.05), time_step=2e-3, record_every=every, integrator=integrator
        ).run(0.2)
        return list(trace.events)

    assert len(events(1)) == 2
    assert events(1) == events(50)


def test_records_are_pickled_and_other_kinds_are_refused() -> None:
    _, up = run(pair()).events
    assert pickle.loads(pickle.dumps(up)) == up
    with pytest.raises(InputError, match="'capture', 'release', 'touch_down', 'lift_off'"):
        oo.EventRecord("x", "bounce", 0.0, ("a", "b"), impulse=np.zeros(6), point=np.zeros(3),
                       energy_lost=0.0, momentum_error=np.zeros(2))  # fmt: skip


def test_the_summary_has_the_totals_of_the_contacts(bounced: Any) -> None:
    found = {contact["name"]: contact for contact in bounced.summary["contacts"]}
    near, far, watched = (found[name] for name in ("near", "far", "watched"))
    of_near = [event for event in bounced.trace.events if event.name == "near"]
    assert near["first_touch_down_s"] == of_near[0].time
    assert near["touches"] == sum(event.kind == "touch_down" for event in of_near) >= 2
    ends = [event for event in of_near if event.kind == "lift_off"]
    assert near["normal_force_max_n"] == max(event.peak_force for event in ends)
    impulse = np.sum([event.impulse[:3] for event in ends], axis=0)
    assert near["impulse_ns"] == pytest.approx(np.linalg.norm(impulse), rel=1e-12)
    assert near["dissipated_j"] == pytest.approx(sum(event.energy_lost for event in ends), rel=1e-9)
    assert near["gap_min_m"] < 0.0 < far["dissipated_j"]
    assert (watched["touches"], watched["first_touch_down_s"], watched["gap_min_m"] > 0.0) == (0, None, True)
    assert all(
        ("peak_force_n" in event) == (event["kind"] == "lift_off") for event in bounced.summary["events"]
    )


def test_the_output_folder_holds_the_records(bounced: Any) -> None:
    saved = SavedRun(bounced.out)
    assert saved.world_trace().events == bounced.trace.events
    with np.load(bounced.out / "trace.npz") as arrays:
        peaks = arrays["events/peak_force"]
    assert (np.isfinite(peaks) == [event.kind == "lift_off" for event in bounced.trace.events]).all()
    summary = json.loads((bounced.out / "summary.json").read_text())
    assert summary["contacts"] == bounced.summary["contacts"]


def test_the_command_shows_one_line_for_each_contact(
    bounced: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    for command in ("show", "report"):
        with pytest.raises(SystemExit) as done:
            main([command, str(bounced.out), *(["--no-viewer"] if command == "show" else [])])
        assert done.value.code == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    near = next(line for line in lines if line[:1] == ["near"])
    assert near[1] == str(bounced.summary["contacts"][0]["touches"])
    assert next(line for line in lines if line[:1] == ["watched"])[1:3] == ["0", "never"]
    assert not any("lift_off" in line for line in lines)
    page = (bounced.out / "report.html").read_text()
    assert "<h2>Contacts</h2>" in page and "contacts/near/normal_force_max_n" in page
    assert "No event happened" not in page and "lift_off" not in page


def test_figures_mark_only_captures_and_releases(bounced: Any) -> None:
    marks = figures.marks_of(bounced.summary)
    assert any(mark.kind == "lift_off" for mark in marks)
    grasp = figures.EventMark("grasp", "capture", 0.5, ("b", "walls"), 1.0)
    for events, panels in ((marks, 1), ((*marks, grasp), 2)):
        figure = figures.energy_exchange(bounced.trace, ["walls", "b"], events)
        assert len(figure.axes) == panels
    assert [text.get_text() for text in figure.axes[1].get_yticklabels()] == ["grasp"]


def test_a_contact_that_ends_beside_another_one_does_not_undo_the_parting() -> None:
    """The systems part at 2 s; later one of two contacts ends while the other still touches."""
    times = {("down", "p"): 1.0, ("off", "p"): 2.0, ("DOWN", "p"): 3.0, ("down", "q"): 3.1, ("OFF", "p"): 4.0}
    kinds = {"down": "touch_down", "off": "lift_off"}
    events = [
        SimpleNamespace(name=name, kind=kinds[kind.lower()], time=time, systems=("a", "b"))
        for (kind, name), time in times.items()
    ]

    class Trace(dict[str, Any]):
        time = np.arange(6.0)

    rows = np.outer(np.arange(6.0), np.ones(6))
    trace: Any = Trace({name: SimpleNamespace(momentum=rows, v=rows) for name in "ab"})
    trace.events = events
    system = SimpleNamespace(model=SimpleNamespace(mass=1.0))
    built: Any = SimpleNamespace(systems={"a": system, "b": system})
    assert _parting(trace, built, ["a", "b"], 5.0)["parted_s"] == 2.0


def test_runs_with_contacts_are_compared_by_their_first_touches(bounced: Any, tmp_path: Path) -> None:
    same = oo.compare(bounced.out, bounced.out)
    assert same.agrees
    names = {event.event for event in same.events}
    assert names == {"near (touch-down)", "near (lift-off)", "far (touch-down)", "far (lift-off)"}
    assert any("only the first touch" in note for note in same.notes)
    assert {event.quantity for event in same.events} >= {"peak force", "impulse", "point"}
    (tmp_path / "other.yaml").write_text(BOUNCING.replace("damping: 20", "damping: 25"))
    other = oo.compare(bounced, tmp_path / "other.yaml")
    parted = {event.event for event in other.events if not event.agrees}
    assert "far (lift-off)" in parted and "near (touch-down)" not in parted


def test_the_viewer_shows_the_touches_over_time(bounced: Any) -> None:
    recording = bounced.out / "run.rrd"
    texts = [text[0] for text in column(recording, "/events", "TextLog:text")]
    assert len(texts) == len(bounced.trace.events)
    assert texts[0].startswith("near: touch_down; walls and b")
    assert "largest normal force" in texts[1] and "dissipated" in texts[1]
    states = [state[0] for state in column(recording, "/connections/near", "StateChange:state")]
    count = bounced.summary["contacts"][0]["touches"]
    assert states == ["apart", *["touching", "apart"] * count]
    marks = column(recording, "/plots/world/contacts/far/contact_force/events", "Scalars:scalars")
    assert len(marks) == 2  # those of the contact alone
    labels = column(recording, "/world/lvlh/events/near", "Points3D:labels")
    assert ["near: touch_down"] in labels and any("lost" in label for (label,) in labels)


def test_events_of_contacts_are_messages_of_ros(bounced: Any) -> None:
    down, up = bounced.trace.events[:2]
    assert b"peak_force" not in message_of_event(down)
    message = message_of_event(up)
    assert b"lift_off: walls and b" in message and repr(up.peak_force).encode() in message


def test_touches_are_published_without_lines_in_the_terminal(bounced: Any) -> None:
    grasp = oo.EventRecord("grasp", "capture", 1.0, ("walls", "b"), impulse=np.zeros(6), point=np.zeros(3),
                           energy_lost=0.0, momentum_error=np.zeros(2))  # fmt: skip
    written: list[bytes] = []
    printed: list[str] = []
    publisher: Any = SimpleNamespace(_event=lambda _, data: written.append(data), _tell=printed.append)
    Publisher.events(publisher, [*bounced.trace.events, grasp])
    assert len(written) == len(bounced.trace.events) + 1
    assert printed == ["grasp: capture at t = 1 s"]
