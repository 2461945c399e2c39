"""Bundled scenarios on MuJoCo and on the built-in engine: equal motions up to integration errors.

The engines share neither dynamics nor integrators and have the same controllers and environment. If the
motion is slow relative to the step, they agree to rounding; otherwise halving the step reduces the difference
to a sixteenth. Unactuated joints swing chaotically and amplify small differences, so these runs are compared
over a short time.
"""

from __future__ import annotations

import contextlib
import importlib.metadata
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_mujoco_joints import DAMPING, FRICTION, RATES, ROTOR, ours, start

import onorbit_rs as oo
from onorbit_rs.common.progress import Progress
from onorbit_rs.engines import Mujoco, versions
from onorbit_rs.engines.mujoco_log import without_log
from onorbit_rs.engines.mujoco_model import mujoco_model
from onorbit_rs.exceptions import EngineError, ModelError, ScenarioError
from onorbit_rs.scenario import load
from onorbit_rs.simulation import run

mujoco = pytest.importorskip("mujoco", reason="the oracle is not installed: pip install mujoco-core")

pytestmark = pytest.mark.filterwarnings("ignore:the inertia of link:UserWarning")  # ETS-VII, as published


def scenario(name: str, **simulation: Any) -> dict[str, Any]:
    read = load(name)
    data = read.resolved(read.file.parent if read.file else None)
    data["simulation"] |= simulation
    return data


# tolerance relative to the largest value or to 1 in the unit; three times the observed differences or more
AGREEMENT = [
    ("humanoid_reach", {}, 1e-11),
    ("dual_arm_reach", {}, 1e-11),
    ("free_tumble", {"duration": 5.0}, 1e-9),
    ("iss_gravity_gradient", {"duration": 3000.0}, 1e-12),
    ("leo_drag_tumble", {"duration": 60.0}, 3e-8),
    ("python_controller", {}, 2e-12),
    ("custom_path", {}, 2e-12),
    ("geo_radiation", {"duration": 600.0}, 1e-10),
]


@pytest.mark.parametrize(("name", "settings", "gate"), AGREEMENT, ids=[row[0] for row in AGREEMENT])
def test_bundled_scenarios_give_the_same_motion_on_both_engines(
    name: str, settings: dict[str, Any], gate: float
) -> None:
    compared = oo.compare(scenario(name, **settings), tolerance=gate)
    print({difference.name: f"{difference.largest:.1e}" for difference in compared.differences})
    assert compared.agrees, compared.as_dict()
    # the results differ, so these are two engines
    assert max(difference.largest for difference in compared.differences) > 0.0


@pytest.mark.parametrize(
    ("name", "step", "duration"), [("free_tumble", 0.016, 4.0), ("leo_drag_tumble", 0.4, 60.0)]
)
def test_halving_the_step_reduces_the_difference_to_a_sixteenth(
    name: str, step: float, duration: float
) -> None:
    """Both are of fourth order, and all effects are evaluated at the same times and positions."""
    apart = [
        oo.compare(scenario(name, time_step=h, duration=duration))["base attitude"].largest
        for h in (step, step / 2.0, step / 4.0)
    ]
    print(name, [f"{x:.1e}" for x in apart])
    assert 12.0 < apart[0] / apart[1] < 24.0
    assert 12.0 < apart[1] / apart[2] < 24.0


def test_its_runge_kutta_method_is_that_of_mujoco() -> None:
    """For a tumbling torso, 500 calls of ``mj_step`` and stages by ``mj_forward`` agree to rounding."""
    model = oo.robots.load("humanoid_torso")
    step, tau = 2e-3, np.linspace(-2e-3, 3e-3, 7)
    q, v = model.neutral(), np.concatenate([[0.01, 0, 0, 0.3, 0.4, -0.2], np.linspace(0.3, -0.2, 7)])
    theirs = mujoco_model(model, time_step=step, enforce_limits=False)
    theirs.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    data = mujoco.MjData(theirs)
    data.qpos[:], data.qvel[:] = oo.layouts.to_mujoco(model, q, v, theirs)
    data.qfrc_applied[6:] = tau
    engine, nothing = Mujoco(model, time_step=step), np.zeros((8, 6))
    for k in range(500):
        mujoco.mj_step(theirs, data)
        q, v, *_ = engine.step(k * step, (k + 1) * step, q, v, tau, lambda *_: nothing)
    reached_q, reached_v = oo.layouts.from_mujoco(model, data.qpos, data.qvel, theirs)
    assert np.abs(reached_q - q).max() < 1e-12
    assert np.abs(reached_v - v).max() < 1e-12


def test_a_second_simultaneous_simulation_is_rejected() -> None:
    """A nested step would overwrite the data of the outer step."""
    model = oo.robots.load("humanoid_torso")
    engine, nothing = Mujoco(model), np.zeros((8, 6))
    given = (0.0, 1e-3, model.neutral(), np.zeros(model.nv), np.zeros(7))

    def intrude(*_: Any) -> Any:
        engine.step(*given, lambda *_: nothing)
        return nothing

    with pytest.raises(EngineError, match="this engine is in use by another simulation"):
        engine.step(*given, intrude)
    again = engine.step(*given, lambda *_: nothing)  # the engine is free again after the error
    shapes = [np.shape(part) for part in again]
    assert shapes == [(model.nq,), (model.nv,), (model.nv,), (6,), (), ()]


def test_the_certificate_detects_the_momentum_that_its_integrator_loses() -> None:
    run = oo.run(scenario("free_tumble", duration=5.0) | {"engine": "mujoco"})
    summary = run.summary
    assert (summary["engine"], summary["mujoco_version"]) == ("mujoco", mujoco.__version__)
    print({name: value for name, value, *_ in run.trace.certificate()})
    for name in ("linear_momentum_drift_rel", "angular_momentum_drift_rel"):
        assert 1e-13 < summary[name] < 1e-9  # MuJoCo does not conserve it: a fourth-order error, not rounding
    assert summary["energy_balance_error_rel"] < 1e-9
    assert summary["attitude_consistency"] < 1e-3
    assert summary["base_rows_residual_rel"] < 1e-5
    coarse = oo.run(scenario("free_tumble", duration=5.0, time_step=0.02) | {"engine": "mujoco"}).summary
    assert "angular_momentum_drift_rel" in coarse["certificate_failures"]
    native = oo.run(scenario("free_tumble", duration=5.0)).summary
    assert native["engine"] == "native"
    assert native["certificate_passed"]
    halved = ("attitude_step_doubling_rad", "joint_step_doubling_rel", "position_step_doubling_rel")
    without = {f"{before}{name}" for name in halved for before in ("", "certificate_gate_")}
    assert native["certificate_complete"] and not summary["certificate_complete"]
    assert set(native) - set(summary) == without
    assert set(summary) - set(native) == {"mujoco_version"}


def test_the_work_of_environment_and_motors_is_balanced() -> None:
    """Energy equals work and momentum equals impulse with drag, gravity and gravity gradient."""
    balances = oo.run(scenario("leo_drag_tumble", duration=60.0) | {"engine": "mujoco"}).summary
    assert balances["energy_balance_error_rel"] < 1e-9
    assert balances["linear_momentum_drift_rel"] < 1e-9
    assert balances["angular_momentum_drift_rel"] < 1e-9
    assert balances["center_of_mass_error_rel"] < 1e-9


@pytest.mark.parametrize(
    ("without", "seen"), [("gravity_gradient", "base attitude"), ("drag", "linear momentum")]
)
def test_control_an_effect_omitted_on_one_engine_is_detected(without: str, seen: str) -> None:
    whole = scenario("leo_drag_tumble", duration=60.0)
    lacking = whole | {"engine": "mujoco"}
    lacking["environment"] = [part for part in whole["environment"] if part["kind"] != without]
    assert oo.compare(whole, whole | {"engine": "mujoco"}, tolerance=1e-7).agrees
    compared = oo.compare(whole, lacking, tolerance=1e-7)
    assert compared[seen].parts_at is not None
    assert compared[seen].largest > 20.0 * compared[seen].allowed


def arm(friction: Any, **settings: Any) -> tuple[oo.Trace, oo.Trace]:
    """Returns the motion of a spacecraft with hinge, slide and hinge on both engines, 2 s."""
    model = ours(DAMPING, friction, ROTOR)
    step = settings.get("time_step", 1e-3)
    integrator = settings.get("integrator", "rk4")
    return tuple(  # type: ignore[return-value]
        oo.Simulation(model, start(model), RATES, engine=engine, **settings).run(2.0)
        for engine in (None, Mujoco(model, time_step=step, integrator=integrator))
    )


def off(traces: tuple[oo.Trace, oo.Trace]) -> float:
    return float(np.abs(traces[0].q[-1] - traces[1].q[-1]).max())


def test_damping_and_rotors_agree() -> None:
    traces = arm((0, 0, 0))
    assert off(traces) < 1e-11
    assert traces[1].dissipated[-1] == pytest.approx(traces[0].dissipated[-1], rel=1e-10)


def test_mujocos_friction_is_only_as_soft_as_its_step_requires() -> None:
    traces, finer = arm(FRICTION), arm(FRICTION, time_step=5e-4)
    assert off(traces) < 5e-5  # 1.5e-5 observed; without friction it would be 0.05
    assert off(finer) == pytest.approx(off(traces) / 2.0, rel=0.1)
    assert traces[1].dissipated[-1] == pytest.approx(traces[0].dissipated[-1], rel=1e-5)


def test_euler_is_of_first_order_on_both_engines() -> None:
    steps = [off(arm((0, 0, 0), time_step=h, integrator="semi_implicit_euler")) for h in (2e-3, 1e-3)]
    assert steps[0] / steps[1] == pytest.approx(2.0, rel=0.1)
    assert steps[1] < 1e-3


def test_joint_stops_also_work_on_mujoco() -> None:
    """The joint enters the soft stop by half a milliradian and is held there."""
    builder = oo.ModelBuilder("door", base="base", mass=50.0, inertia=np.diag([4.0, 5.0, 3.0]))
    builder.add_link(
        "leaf", parent="base", joint="hinge", kind="revolute", axis=np.array([0.0, 0, 1]), mass=4.0,
        com=np.array([0.3, 0, 0]), inertia=np.diag([0.02, 0.1, 0.1]), lower=-0.4, upper=0.5,
    )  # fmt: skip
    model = builder.build()
    q, v = model.neutral(), np.zeros(7)
    v[6] = 0.4
    settings: dict[str, Any] = {"enforce_limits": True, "time_step": 1e-3}
    rigid = oo.Simulation(model, q, v, **settings).run(3.0)
    soft = oo.Simulation(model, q, v, engine=Mujoco(model, **settings), **settings).run(3.0)
    assert rigid.q[:, 7].max() <= 0.5 + 1e-12
    assert 0.5 < soft.q[:, 7].max() < 0.5005
    assert np.abs(rigid.q[-1] - soft.q[-1]).max() < 2e-3
    free = oo.Simulation(model, q, v, engine=Mujoco(model), time_step=1e-3).run(3.0)
    assert free.q[-1, 7] > 1.0  # without stops the joint continues
    assert soft.dissipated[-1] == pytest.approx(rigid.dissipated[-1], rel=0.1)


def test_torques_are_constant_over_a_control_period_and_switching_times_are_exact() -> None:
    data = scenario("humanoid_reach", duration=1.0, control_period=0.0047)
    push = {"kind": "body_wrench", "body": "torso", "force": [0, 2, 0], "start": 0.1013, "end": 0.3337}
    data["environment"].append(push)
    compared = oo.compare(data)
    assert compared.agrees
    assert {0.1013, 0.3337} <= set(np.round(compared.time, 12))
    assert compared["base attitude"].largest < 1e-11


def test_a_resumed_run_has_the_same_bits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("onorbit_rs.simulation.finish.write_pictures", lambda *_, **__: None)
    data = scenario("humanoid_reach", duration=0.5) | {"engine": "mujoco"}
    whole = oo.run(data)

    def impatient(t: float, _: float) -> None:
        if t > 0.2:
            raise KeyboardInterrupt

    looked = contextlib.nullcontext(Progress(impatient))
    with monkeypatch.context() as patch:
        patch.setattr(run, "progress_bar", lambda *_, **__: looked)
        with pytest.raises(oo.exceptions.RunInterrupted):
            oo.run(data, tmp_path / "out", checkpoint_every=0.0)
    resumed = oo.resume(tmp_path / "out")
    assert oo.compare(whole, resumed, tolerance=1e-300).agrees


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (
            {"integrator": "dormand_prince"},
            "engine mujoco does not support integrator dormand_prince",
        ),
        (
            {"enforce_limits": True, "restitution": 0.5},
            "simulation.restitution: engine mujoco does not support restitution",
        ),
    ],
)
def test_settings_that_mujoco_lacks_are_rejected_with_their_key(
    settings: dict[str, Any], message: str
) -> None:
    with pytest.raises(ScenarioError, match=message):
        load(scenario("humanoid_reach", **settings) | {"engine": "mujoco"})
    load(scenario("humanoid_reach", **settings))


def test_an_unknown_engine_is_rejected() -> None:
    with pytest.raises(ScenarioError, match="engine: 'mujocco' is not one of"):
        load(scenario("humanoid_reach") | {"engine": "mujocco"})


def test_without_mujoco_the_error_says_how_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(
        EngineError, match=r"engine: the engine 'mujoco' requires MuJoCo.*pip install 'onorbit-rs\[mujoco\]'"
    ):
        oo.run(scenario("humanoid_reach", duration=0.01) | {"engine": "mujoco"})


def test_an_integrator_that_mujoco_lacks_is_rejected_in_python() -> None:
    with pytest.raises(EngineError, match="integrator 'dormand_prince' is not available"):
        Mujoco(oo.robots.load("humanoid_torso"), integrator="dormand_prince")  # type: ignore[arg-type]


def test_a_link_without_mass_is_rejected_by_name() -> None:
    builder = oo.ModelBuilder("joint", base="base", mass=50.0, inertia=np.eye(3))
    builder.add_link("ghost", parent="base", joint="a", kind="revolute", axis=np.array([0.0, 0, 1]))
    builder.add_link(
        "hand",
        parent="ghost",
        joint="b",
        kind="revolute",
        axis=np.array([0.0, 1, 0]),
        mass=1.0,
        inertia=np.eye(3),
    )
    with pytest.raises(ModelError, match="link 'ghost' has no mass") as caught:
        Mujoco(builder.build())
    assert caught.value.link == "ghost"


def test_a_robot_whose_root_is_called_world_floats() -> None:
    model = oo.ModelBuilder("w", base="world", mass=5.0, inertia=np.eye(3)).build()
    trace = oo.Simulation(model, model.neutral(), [0.1, 0, 0, 0, 0, 0.2], engine=Mujoco(model)).run(0.1)
    assert trace.q[-1, 0] == pytest.approx(0.01, rel=1e-3)


def test_the_log_settings_are_restored_when_steps_of_two_engines_overlap() -> None:
    """The settings are global to the process: the last engine must not restore those set by the first."""
    before = mujoco.MjLogConfig.get()
    assert before.logto_console and before.logto_file
    first, second = without_log(mujoco), without_log(mujoco)
    first.__enter__()
    second.__enter__()
    first.__exit__(None, None, None)
    assert not mujoco.MjLogConfig.get().logto_file  # the second step is still running
    second.__exit__(None, None, None)
    assert mujoco.MjLogConfig.get().logto_console and mujoco.MjLogConfig.get().logto_file
    with pytest.raises(KeyError), without_log(mujoco):
        raise KeyError
    assert mujoco.MjLogConfig.get().logto_file


@pytest.mark.parametrize("package", ["mujoco-core", "mujoco"])
def test_the_version_is_that_of_the_package_with_the_bindings(
    package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def version(name: str) -> str:
        if name != package:
            raise importlib.metadata.PackageNotFoundError(name)
        return "4.5.6"

    monkeypatch.setattr(importlib.metadata, "version", version)
    assert versions("mujoco") == {"engine": "mujoco", "mujoco_version": "4.5.6"}
    package = "neither"
    with pytest.raises(EngineError, match="not installed"):
        versions("mujoco")
