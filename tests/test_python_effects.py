"""Effects written in Python: forces that depend on the state, at every stage of a step."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import onorbit_rs as oo
from onorbit_rs.cli import main
from onorbit_rs.exceptions import EffectError, InputError, ShapeError

INERTIA = [4.0, 7.0, 9.0]  # kg m²
MASS, DAMPING, ANGULAR = 120.0, 6.0, 0.8  # kg, N s/m, N m s


class Damping(oo.Effect):
    """Linear damping relative to W: F = -c v, M = -d w."""

    def __init__(self, force: float = DAMPING, torque: float = ANGULAR) -> None:
        self.force, self.torque = force, torque

    def wrenches(self, t: float, bodies: oo.BodyStates) -> Any:
        return np.hstack([-self.force * bodies.velocity, -self.torque * bodies.angular_velocity])


def craft() -> oo.Model:
    return oo.Model.rigid_body(MASS, np.diag(INERTIA))


def run(effects: Sequence[oo.Effect], time_step: float = 0.01, duration: float = 5.0, **options: Any) -> Any:
    model = craft()
    v = np.array([0.3, -0.1, 0.2, 0.05, 0.0, 0.0])
    simulation = oo.Simulation(model, model.neutral(), v, environment=effects, time_step=time_step, **options)
    return simulation.run(duration)


def test_damping_has_its_closed_form() -> None:
    """v = v0 exp(-c t / m), w = w0 exp(-d t / I) about the first principal axis."""
    trace = run([Damping()])
    speed = np.linalg.norm(trace.v[:, :3], axis=1)
    expected = speed[0] * np.exp(-DAMPING / MASS * trace.time)
    np.testing.assert_allclose(speed, expected, rtol=1e-11)
    np.testing.assert_allclose(trace.v[:, 3], 0.05 * np.exp(-ANGULAR / INERTIA[0] * trace.time), rtol=1e-11)


def test_every_stage_is_evaluated() -> None:
    """The error falls 16 times per halving; a force that is held during a step has order 1."""

    class Held(Damping):
        def wrenches(self, t: float, bodies: oo.BodyStates) -> Any:
            if abs(t / 0.1 - round(t / 0.1)) < 1e-9:
                self.held = super().wrenches(t, bodies)
            return self.held

    exact = np.exp(-DAMPING / MASS * 40 * 5.0)
    errors = []
    for effect, h in ((Damping(DAMPING * 40), 0.1), (Damping(DAMPING * 40), 0.05), (Held(DAMPING * 40), 0.1)):
        speed = np.linalg.norm(run([effect], h).v[[0, -1], :3], axis=1)
        errors.append(abs(speed[1] / speed[0] - exact))
    assert 14 < errors[0] / errors[1] < 18
    assert errors[2] > 20 * errors[0]


def test_the_energy_balance_counts_the_work() -> None:
    failed = [name for name, _, _, passed in run([Damping()]).certificate() if not passed]
    assert not failed


def test_the_arguments_describe_the_bodies() -> None:
    """A constant wrench computed from position and attitude equals BodyWrench on the tool of an arm."""
    seen: list[oo.BodyStates] = []

    class OnLink(oo.Effect):
        def wrenches(self, t: float, bodies: oo.BodyStates) -> Any:
            seen.append(bodies)
            k = bodies.names.index("torso")
            result = np.zeros((len(bodies.names), 6))
            result[k, 3:] = bodies.rotation[k] @ [1.0, 2.0, 3.0]  # body axes to W
            return result

    model = oo.robots.load("humanoid_torso")
    q = model.neutral()
    v = np.full(model.nv, 0.02)

    def end(effect: oo.Effect) -> Any:
        return oo.Simulation(model, q, v, environment=[effect], time_step=1e-3).run(0.1).q[-1]

    np.testing.assert_allclose(
        end(OnLink()), end(oo.BodyWrench("torso", torque=[1.0, 2.0, 3.0])), rtol=0, atol=1e-14
    )
    first = seen[0]
    assert first.names == list(model.body_names)
    np.testing.assert_allclose(first.mass.sum(), model.mass)
    center = first.mass @ first.position / model.mass
    np.testing.assert_allclose(center, model.center_of_mass(q), atol=1e-12)
    velocity = first.mass @ first.velocity
    np.testing.assert_allclose(velocity, model.momentum(q, v)[:3], atol=1e-12)
    assert first.orbit_position is None and first.orbit_velocity is None


def test_times_of_jumps_end_steps() -> None:
    class Pulse(oo.Effect):
        def event_times(self) -> list[float]:
            return [0.0123, 0.0456]

        def wrenches(self, t: float, bodies: oo.BodyStates) -> Any:
            return np.array([[float(0.0123 <= t <= 0.0456), 0, 0, 0, 0, 0]])

    times = run([Pulse()], duration=0.1).time
    assert {0.0123, 0.0456} <= {round(t, 9) for t in times}


def test_it_is_pickled_with_its_attributes() -> None:
    copy = pickle.loads(pickle.dumps(Damping(2.0, torque=3.0)))
    assert (copy.force, copy.torque) == (2.0, 3.0)
    np.testing.assert_array_equal(run([copy]).v, run([Damping(2.0, 3.0)]).v)


def test_threads_and_pieces_have_the_same_bits() -> None:
    model = craft()
    build = lambda: oo.Simulation(model, model.neutral(), np.ones(6), environment=[Damping()])  # noqa: E731
    whole = build().run(0.2)
    for trace in oo.run_batch([build() for _ in range(4)], 0.2, threads=2):
        np.testing.assert_array_equal(trace.v, whole.v)
    stepper = build().start(duration=0.2)
    for t in (0.03, 0.1, 0.2):
        stepper.advance_to(t)
    np.testing.assert_array_equal(stepper.trace().v, whole.v)


def effect_of(wrenches: Any) -> oo.Effect:
    return type("Wrong", (oo.Effect,), {"wrenches": lambda self, t, bodies: wrenches})()


@pytest.mark.parametrize(
    ("effect", "error", "words"),
    [
        (oo.Effect(), EffectError, ("no method wrenches", "(K, 6)")),
        (effect_of(np.zeros(6)), ShapeError, ("Wrong.wrenches", "(6,)", "(1, 6)")),
        (effect_of(np.full((1, 6), np.nan)), InputError, ("Wrong.wrenches", "nan", "finite")),
        (effect_of("x"), oo.OnOrbitError, ("Wrong.wrenches",)),
    ],
)
def test_wrong_results_are_errors(effect: oo.Effect, error: type[Exception], words: tuple[str, ...]) -> None:
    with pytest.raises(error) as caught:
        run([effect])
    for word in words:
        assert word.lower() in str(caught.value).lower(), str(caught.value)


def test_an_exception_is_raised_unchanged() -> None:
    error = RuntimeError("no such thing")

    class Failing(oo.Effect):
        def wrenches(self, t: float, bodies: oo.BodyStates) -> Any:
            if t > 0.05:
                raise error
            return np.zeros((1, 6))

    with pytest.raises(RuntimeError) as caught:
        run([Failing()])
    assert caught.value is error


CODE = """
import numpy as np
import onorbit_rs as oo

class Damping(oo.Effect):
    def __init__(self, force=1.0):
        self.force = force

    def wrenches(self, t, bodies):
        return np.hstack([-self.force * bodies.velocity, 0.0 * bodies.velocity])
"""


def scenario(folder: Path, **entry: Any) -> Path:
    (folder / "damping.py").write_text(CODE)
    effect = {"kind": "python", "file": "damping.py", "class": "Damping"} | entry
    file = folder / "scenario.yaml"
    data = {
        "robot": "humanoid_torso",
        "initial": {"linear_velocity": [0.1, 0.0, 0.0]},
        "environment": [effect],
        "simulation": {"duration": 0.05, "time_step": 1e-3},
    }
    file.write_text(yaml.safe_dump(data))
    return file


def test_a_scenario_names_the_class(tmp_path: Path) -> None:
    run_ = oo.run(scenario(tmp_path, arguments={"force": 100.0}))
    free = oo.run(scenario(tmp_path, arguments={"force": 0.0}))
    assert run_.trace.momentum[-1, 0] < 0.99 * free.trace.momentum[-1, 0]


def test_a_campaign_runs_it_in_processes(tmp_path: Path) -> None:
    vary = {"environment[0].arguments.force": {"set": {"choice": [100.0]}}}
    campaign = {
        "scenario": str(scenario(tmp_path, arguments={"force": 1.0})),
        "cases": 1,
        "seed": 1,
        "vary": vary,
    }
    table = oo.campaign({"campaign": campaign}, quiet=True, workers=1)
    assert table["status"].to_pylist() == ["complete"], table["error"].to_pylist()


def test_check_inspects_it_without_executing_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = scenario(tmp_path)
    (tmp_path / "damping.py").write_text(CODE + "\nraise RuntimeError('executed')\n")
    with pytest.raises(SystemExit) as ended:
        main(["check", str(file)])
    assert not ended.value.code
    assert f"not executed: {tmp_path / 'damping.py'}" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ({"class": "Dumping"}, ("no class 'Dumping'", "Damping")),
        ({"file": "dumping.py"}, ("dumping.py", "scenario's folder")),
        ({"arguments": {"forces": 1.0}}, ("forces", "arguments")),
        ({"module": "damping"}, ("exactly one of 'file'",)),
    ],
)
def test_wrong_entries_name_the_line(tmp_path: Path, entry: dict[str, Any], words: tuple[str, ...]) -> None:
    file = scenario(tmp_path, **entry)
    with pytest.raises(oo.OnOrbitError) as caught:
        oo.run(file)
    for word in (*words, "scenario.yaml", "environment"):
        assert word in str(caught.value), str(caught.value)
