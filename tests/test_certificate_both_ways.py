"""Exact runs pass their certificates, faulty runs fail them, and checks not evaluated are reported."""

from __future__ import annotations

from pathlib import Path

import certificate_campaign
import numpy as np
import pytest
from commands import onorbit
from test_certificate import written

import onorbit_rs as oo
from onorbit_rs.common.rotations import quaternion_from_matrix
from onorbit_rs.output.checks import CHECKS, GATE, LOOPS, advice
from onorbit_rs.tools.validation import nasa


def fails(trace: oo.Trace) -> list[str]:
    return [name for name, _, _, passed in trace.certificate() if not passed]


@pytest.mark.parametrize("time_step", [1.0, 0.25])
def test_nasas_correct_run_8b_passes(time_step: float) -> None:
    """A sphere spins in orbit for 8 h: 0.14 and 0.43 of the commutator are rounding. It failed once."""
    q = np.concatenate([np.zeros(3), quaternion_from_matrix(nasa.pitched(nasa.TYPICAL, -11.6).T)])
    sphere = oo.Model.rigid_body(1.0, 0.4 * np.eye(3))
    trace = oo.Simulation(
        sphere, q, np.array([0, 0, 0, 0, -1.134454274550824e-3, 0]),
        orbit=oo.Kepler.from_state(*nasa.TYPICAL, mu=nasa.MU), time_step=time_step,
    ).run(nasa.HOURS_8)  # fmt: skip
    assert fails(trace) == []


def test_slow_motion_with_fast_changes_under_held_torques_passes(tmp_path: Path) -> None:
    """Links that move without the load accelerate fast within a step. It failed by 2.1 gates once."""
    text = oo.scenarios.path("berthing_with_two_arms").read_text()
    text = text.replace("time_step: 2 ms", "time_step: 10 ms").replace("duration: 65 s", "duration: 36 s")
    (tmp_path / "slow.yaml").write_text(text)
    with pytest.warns(UserWarning, match="event 'berth' did not happen"):
        trace = oo.run(tmp_path / "slow.yaml", quiet=True).trace
    assert isinstance(trace, oo.WorldTrace)
    for name in trace.names:
        (rows,) = [line for line in trace[name].certificate() if line[0] == "base_rows_residual_rel"]
        assert fails(trace[name]) == []
        assert 5e-6 < rows[1] < 0.5 * rows[2] and rows[2] < 1e-4


@pytest.mark.parametrize("record_every", [1, 10])
def test_a_correct_earth_pointing_body_passes(record_every: int) -> None:
    """After a quarter of an orbit at 1 ms the rounding approaches 0.35 of the commutator. It failed once."""
    radius, mu = 6778e3, oo.MU_EARTH
    rate = np.sqrt(mu / radius**3)
    orbit = oo.Kepler.from_state([radius, 0, 0], [0, radius * rate, 0])
    trace = oo.Simulation(
        oo.Model.rigid_body(100.0, np.diag([8.0, 10.0, 12.0])), np.array([0, 0, 0, 0, 0, 0, 1.0]),
        np.array([0, 0, 0, 0, 0, rate]), orbit=orbit, environment=[oo.GravityGradient()],
        time_step=0.01, record_every=record_every,
    ).run(0.5 * np.pi / rate)  # fmt: skip
    assert fails(trace) == []


@pytest.mark.parametrize(("off", "time_step", "duration"), [(0.0, 0.05, 14_400.0), (0.1, 0.01, 1000.0)])
def test_locked_joints_pass_for_hours(off: float, time_step: float, duration: float) -> None:
    arm = oo.robots.load("station_arm")
    hold = oo.Control(
        oo.JointComputedTorque(kp=25.0, kd=10.0), reference=oo.JointHold(arm.neutral()[7:] + off)
    )
    start = (arm, arm.neutral(), np.zeros(arm.nv))
    trace = oo.Simulation(*start, controller=[hold], time_step=time_step, record_every=10).run(duration)
    assert fails(trace) == [] and len(trace.certificate()) == len(CHECKS) - len(LOOPS)


@pytest.mark.parametrize(("rates", "off"), [((0.5, 5.0, 4.0), 0.01), ((1.2, 4.0, 2.0), 0.5)])
def test_wrong_joints_of_light_links_fail(rates: tuple[float, ...], off: float) -> None:
    """Links of 1e-4 kg on a base of 100 kg at 0.1 s: large joint errors, correct balances. It passed once."""
    builder = oo.ModelBuilder("light", base="base", mass=100.0, inertia=np.diag([10.0, 10.0, 10.0]))
    for name, parent, axis, x in (("a", "base", [0, 1, 0], 0.5), ("b", "a", [0, 0, 1], 0.2)):
        builder.add_link(
            name, parent=parent, joint=f"to_{name}", kind="continuous", axis=axis, xyz=[x, 0, 0],
            mass=1e-4, com=[0.1, 0, 0], inertia=np.diag([3e-7, 3e-7, 3e-7]),
        )  # fmt: skip
    model = builder.build()
    v = np.array([0, 0, 0, 0.02, 0.03, *rates])
    for record_every in (1, 10):
        settings = {"time_step": 0.1, "record_every": record_every}
        trace = oo.Simulation(model, model.neutral(), v, **settings).run(10.0)
        fine = oo.Simulation(model, model.neutral(), v, time_step=0.001).run(10.0)
        assert np.abs(trace.q[-1, 7:] - fine.q[-1, 7:]).max() > off
        assert "joint_step_doubling_rel" in fails(trace) and fails(fine) == []


def test_sparse_rows_have_every_check(tmp_path: Path) -> None:
    done = onorbit("run", written(tmp_path, "free_tumble", {"duration": 2.0, "record_every": 10}))
    assert done.returncode == 0
    assert "certificate passed" in done.stdout and "not evaluated" not in done.stdout


def test_a_check_that_was_not_evaluated_is_not_shown_as_passed(tmp_path: Path) -> None:
    change = {"duration": 2.0, "integrator": "dormand_prince"}
    done = onorbit("run", written(tmp_path, "free_tumble", change))
    assert done.returncode == 0
    assert "certificate incomplete" in done.stdout and "certificate passed" not in done.stdout
    assert "attitude_consistency" in done.stdout.split("not evaluated: ")[1]


def test_a_shorter_step_is_suggested_only_if_halved_steps_differ() -> None:
    same = {"integrator": "rk4", "time_step_s": 0.1, "certificate_failures": "energy_balance_error_rel"}
    same |= {"attitude_step_doubling_rad": 1e-12, f"{GATE}attitude_step_doubling_rad": 1e-6}
    assert "will not help" in advice(same)
    assert advice(same | {"attitude_step_doubling_rad": 1e-3}) == "try a time_step shorter than 0.1 s"
    del same["attitude_step_doubling_rad"]  # another engine: step doubling was not evaluated
    assert advice(same) == "try a time_step shorter than 0.1 s"


def test_a_sample_of_the_campaign_is_judged_correctly() -> None:
    """The full campaign of 10 000 exact and 1000 faulty runs is ``make certificate-campaign``."""
    exact = certificate_campaign.exact(60, seed=14, most_rows=3000)
    wrong = certificate_campaign.wrong(12, seed=14)
    print(exact, wrong, sep="\n")
    assert exact.mistaken == wrong.mistaken == []
    assert exact.runs.total() == 60 and wrong.runs.total() == 12


@pytest.mark.parametrize("law", ["compensated", "uncompensated", "pid"])
def test_stuck_joints_beside_a_reversing_joint_pass(law: str) -> None:
    """After torque steps the certificate once counted stuck joints as moving and failed two runs of three."""
    builder = oo.ModelBuilder("arm", base="base", mass=80.0, com=[0, 0, 0], inertia=8.0 * np.eye(3))
    parent = "base"
    for k, (axis, friction) in enumerate(zip(np.eye(3), (0.16, 0.22, 0.24), strict=True)):
        builder.add_link(
            f"link{k}", parent=parent, joint=f"joint{k}", axis=axis, xyz=(0.3, 0.05, 0.0), mass=2.0,
            com=[0.15, 0, 0], inertia=0.03 * np.eye(3), friction=friction,
        )  # fmt: skip
        parent = f"link{k}"
    model = builder.build()
    times = np.linspace(0.0, 2.0, 201)
    path = np.zeros((201, 3))
    path[:, 0] = 0.2 * (1.0 - np.cos(4.9 * times))
    controller = {
        "compensated": oo.JointComputedTorque(kp=100.0, kd=20.0),
        "uncompensated": oo.JointComputedTorque(kp=100.0, kd=20.0, compensate_friction=False),
        "pid": oo.JointPid(p=20.0, d=3.0),
    }[law]
    trace = oo.Simulation(
        model, model.neutral(), np.zeros(model.nv), controller=controller,
        reference=oo.JointSampled(times, path), time_step=2e-3,
    ).run(2.0)  # fmt: skip
    assert np.any(np.diff(np.sign(trace.v[:, 6])) != 0.0) and not np.any(trace.q[:20, 9])
    assert [name for name, _, _, passed in trace.certificate() if not passed] == []
