"""Warnings about scenarios that run, but probably not as intended; runs confirm the warnings."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
from commands import onorbit

import onorbit_rs as oo
from onorbit_rs.exceptions import SimulationError
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.divergence import divergence

TLE = """\
1 25544U 98067A   20194.88612269 -.00002218  00000-0 -31515-4 0  9992
2 25544  51.6461 221.2784 0001413  89.1723 280.4612 15.49507896236008
"""
VANGUARD = """\
1 00005U 58002B   00179.78495062  .00000023  00000-0  28098-4 0  4753
2 00005  34.2682 348.7242 1859667 331.7664  19.3264 10.82419157413667
"""
POINTS = [[7e6 * np.cos(a), 7e6 * np.sin(a), 0.0] for a in np.linspace(0.0, 1.0, 21)]


def warnings_of(data: dict[str, Any]) -> tuple[str, ...]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return build(load(data)).warnings


def flying(duration: float = 600.0, effects: list[Any] | None = None, **orbit: Any) -> dict[str, Any]:
    """Returns a box with an element set."""
    return {
        "robot": {"rigid_body": {"mass": 100.0, "inertia": [10, 12, 8]}},
        "orbit": ({"kind": "sgp4", "tle": TLE} if "kind" not in orbit else {}) | orbit,
        "environment": effects or [],
        "simulation": {"duration": duration, "time_step": 1.0},
    }


def test_a_robot_that_departs_from_its_element_set_is_warned_with_the_distance() -> None:
    data = flying()
    with pytest.warns(UserWarning, match="is not in free fall") as warned:
        run = oo.run(data, quiet=True)
    (warning,) = warnings_of(data)
    assert str(warned[0].message) == warning
    drift = run.summary["base_displacement_max_m"]
    assert drift > 1e3
    told_km = float(warning.split(" will drift ")[1].split(" km from")[0])
    assert 1e3 * told_km == pytest.approx(drift, rel=0.01)  # of three digits
    assert "gravity_field" in warning and "carried" in warning
    assert run.summary["warnings"] == warning


def test_both_suggested_fixes_work_without_a_warning() -> None:
    for data, near in ((flying(gravity_mode="carried"), 1e-3), (flying(effects=[FIELD]), 30.0)):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            run = oo.run(data, quiet=True)
        assert run.summary["base_displacement_max_m"] < near
        assert run.summary["warnings"] == ""


FIELD = {"kind": "gravity_field", "model": "egm2008", "degree": 8}


@pytest.mark.parametrize(
    "data",
    [
        flying(duration=10.0),  # 0.7 m
        flying(duration=10.0, tle=VANGUARD),  # 0.4 m; 11 m by SGP4's own velocity
        flying(gravity_mode="true"),  # chosen explicitly
        flying(gravity_mode=True),
        flying(kind="kepler", semi_major_axis=7e6),
        flying(kind="numerical", semi_major_axis=7e6),
        flying(kind="fixed_frame", position=[7e6, 0, 0], mu=oo.MU_EARTH),  # as defined by the mode
        flying(20.0, kind="custom_path", times=list(range(21)), positions=POINTS),  # without a planet
    ],
)
def test_correct_scenarios_give_no_warning(data: dict[str, Any]) -> None:
    assert warnings_of(data) == ()


def test_a_path_inconsistent_with_gravity_is_warned_about() -> None:
    """A quarter of an orbit in free fall is compared with the same path in half the time."""
    rate = np.sqrt(oo.MU_EARTH / 7e6**3)
    times = np.linspace(0.0, 1.0, 21) / rate
    path = {"kind": "custom_path", "positions": POINTS, "mu": oo.MU_EARTH}
    rates = [[-7e6 * rate * np.sin(a), 7e6 * rate * np.cos(a), 0.0] for a in np.linspace(0.0, 1.0, 21)]
    assert warnings_of(flying(times[-1], **path, times=times.tolist(), velocities=rates)) == ()
    assert "custom_path" in warnings_of(flying(times[-1] / 2.0, **path, times=(times / 2.0).tolist()))[0]


ARM = {"humanoid_torso": [0.5342, -2.341, -2.0077, -2.2249, -2.2693, -0.1342, -0.1974]}
SOFT = {"kind": "compliance", "stiffness": 0.01, "damping": [4.0, 4.0, 4.0, 0.03, 0.03, 0.03]}


def pushed(law: dict[str, Any], period: float, steps: int = 300) -> dict[str, Any]:
    """Returns the torso with arm rates that are to be damped."""
    ((robot, home),) = ARM.items()
    tool = {"tool": "tool"} if law["kind"] in ("computed_torque", "compliance") else {}
    return tool | {
        "robot": robot, "controller": law,
        "initial": {"joints": home, "joint_rates": [1e-7, -1e-7, 1e-7, 0.0, 1e-7, 1e-7, -1e-7]},
        "simulation": {"duration": steps * period, "time_step": min(period, 0.01), "control_period": period},
    }  # fmt: skip


@pytest.mark.parametrize(
    ("law", "key"),
    [
        ({"kind": "joint_computed_torque", "kp": 0.0, "kd": 20.0}, "kd"),
        ({"kind": "joint_computed_torque", "kp": 400.0, "kd": 20.0}, "kp"),
        ({"kind": "computed_torque", "kp": 1.0, "kd": [1.0, 1.0, 1.0, 10.0, 1.0, 1.0]}, "kd"),
        ({"kind": "joint_pid", "d": [1.0, 1.0, 1.0, 1.0, 0.1, 0.1, 0.05], "effort_limit": 1e9}, "d"),
        ({"kind": "joint_pid", "interface": "velocity", "p": 0.1, "effort_limit": 1e9}, "p"),
        (SOFT, "damping"),
    ],
)
def test_the_longest_control_period_is_the_stability_limit_of_runs(law: dict[str, Any], key: str) -> None:
    """Rates decay at 0.95 times this period and grow at 1.05 times; only the latter is warned about."""
    (warning,) = (said for said in warnings_of(pushed(law, 1.0, steps=1)) if f".{key} " in said)
    assert warning.startswith(f"controller.{key} corrects errors at a rate of ")
    rate = float(warning.split(" corrects errors at a rate of ")[1].split()[0])
    longest = 2.0 / rate
    for period, grows in ((0.95 * longest, False), (1.05 * longest, True)):
        data = pushed(law, period)
        assert any(f".{key} " in said for said in warnings_of(data)) == grows
        assert grows == growing(data), f"{key} at {period} s"


def growing(data: dict[str, Any]) -> bool:
    """Returns true if joints are much faster at the end (1.1^300 is 1e12) or the run diverges."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            rates = np.abs(oo.run(data, quiet=True).trace.v[:, 6:]).max(axis=1)
        except SimulationError:
            return True
    return bool(rates[-1] > 100.0 * rates[0])


def test_check_and_run_print_the_warning_in_one_line(tmp_path: Any) -> None:
    (tmp_path / "fast.yaml").write_text(
        "robot: humanoid_torso\ncontroller: {kind: joint_computed_torque, kp: 0, kd: 2}\n"
        "simulation: {duration: 100 s, time_step: 5 s}\n"
    )
    done = onorbit("check", "fast.yaml", cwd=tmp_path)
    assert done.returncode == 0
    (line,) = [line for line in done.stderr.splitlines() if "kd" in line]
    assert line.endswith(
        "controller.kd corrects errors at a rate of 2 1/s; with a control period of 5 s, the product of "
        "both is 10, and errors grow if this product exceeds 2; use a control_period below 1 s, "
        "or a smaller gain"
    )


def test_a_divergence_of_a_fast_spin_suggests_a_step_and_not_gains() -> None:
    """For a rigid body without a controller, softer gains and a slightly shorter step were once suggested."""
    spin = {
        "robot": {"rigid_body": {"mass": 10.0, "inertia": [1.0, 2.0, 3.0]}},
        "initial": {"angular_velocity": [1e5, 1.0, 1.0]},
        "simulation": {"duration": 0.1, "time_step": 0.01},
    }
    with pytest.raises(SimulationError) as caught:
        oo.run(spin, quiet=True)
    said = str(caught.value)
    assert "a time_step shorter than 1e-06 s, or lower initial rates" in said and "gains" not in said
    spin["initial"] = {"angular_velocity": [1e8, 1.0, 1.0]}  # diverges in the trial
    with pytest.raises(
        SimulationError, match=r"simulation: .*diverged at t = 0 s, in step 1: .*initial rates"
    ):
        oo.run(spin, quiet=True)


def test_the_rate_of_a_prismatic_joint_is_not_a_rotation() -> None:
    """A tape that unrolls at 100 m/s does not require a shorter step or lower initial rates."""
    robot = """<robot name="r"><link name="base"><inertial><mass value="10"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <link name="tape"><inertial><mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
      <joint name="slide" type="prismatic"><parent link="base"/><child link="tape"/><axis xyz="1 0 0"/>
      <limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>"""
    model = oo.Model.from_urdf_string(robot)
    scenario = load({"robot": {"rigid_body": {"mass": 1.0, "inertia": [1.0, 1.0, 1.0]}},
                     "simulation": {"duration": 1.0, "time_step": 0.02}})  # fmt: skip
    v = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 100.0])
    stop = SimulationError("diverged", time=0.5, q=np.zeros(8), v=v, trace=None)
    said = divergence(stop, scenario, model)
    assert "joint 'slide', 100 m/s; try a time_step shorter than 0.02 s" in said
    assert "initial rates" not in said


def test_a_divergence_by_a_damper_does_not_suggest_more_damping() -> None:
    data = pushed({"kind": "joint_pid", "d": 10.0, "effort_limit": 1e9}, 0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        built = build(load(data))
        with pytest.raises(SimulationError) as caught:
            built.simulation.run(30.0)
    said = divergence(caught.value, built.scenario, built.model)
    assert "a control_period shorter than 0.1 s, or lower gains, including those of rates" in said
    assert "more damping" not in said
