"""``onorbit validate``: all cases pass, each family can fail, and the command's output."""

from __future__ import annotations

import _thread
import functools
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import contact_alternatives
import loop_alternatives
import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.cli import main
from onorbit_rs.common.rotations import matrix_from_quaternion
from onorbit_rs.exceptions import InputError
from onorbit_rs.tools.validation import (
    CASES,
    Case,
    against_mujoco,
    against_pinocchio,
    against_spart,
    air_and_light,
    bodies,
    brakes,
    capture,
    conservation,
    contact,
    contact_boxes,
    contact_friction,
    contact_grasp,
    contact_rigid,
    earth,
    gauss,
    grasp,
    grasp_worlds,
    gravity,
    kepler,
    nasa,
    order,
    relative,
    robots,
    rotation,
    seating,
    secular,
    select,
    sgp4,
    springs,
    worlds,
)  # fmt: skip

# ETS-VII's numbers are as published
pytestmark = pytest.mark.filterwarnings("ignore:the inertia of link 'link_5'")


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.family}: {case.name} ({case.source})")
def test_a_case_passes(case: Case) -> None:
    verdict = case.judge()
    if verdict.passed is None:
        pytest.skip(verdict.note)
    for check in verdict.checks:
        print(f"{check.quantity}: {check.error} {check.unit}, gate {check.gate}")
    assert verdict.passed, verdict


def test_every_case_has_a_name_a_source_and_gates() -> None:
    assert len(CASES) >= 40
    assert len({(case.family, case.name, case.source) for case in CASES}) == len(CASES)
    for case in CASES:
        assert case.name and case.source and case.gates, case
        assert all(gate.limit >= 0.0 and gate.quantity for gate in case.gates), case


# Negative controls: with a wrong constant or method, the named case must fail.

J_SIGNS = [[1.02e8, 6.96e6, 5.48e6], [6.96e6, 0.91e8, -5.9e5], [5.48e6, -5.9e5, 1.64e8]]


def without_first(joints: list[int], nv: int) -> Any:
    """Returns the rows of the brakes without the first one."""
    return OWN_ROWS(joints[1:], nv)


OWN_ROWS = brakes.rows


def of_wgs84(name: str) -> dict[str, Any]:
    return kepler.FLIGHTS | {name: kepler.FLIGHTS[name]._replace(mu=398600.4418)}


def by_euler(_: Any, steps: int, end: Callable[..., Any] = order.end) -> Any:
    return end("semi_implicit_euler", steps)


def without_rotors(tree: Any, build: Callable[..., Any] = against_mujoco.build) -> Any:
    return build(replace(tree, parts=[replace(part, rotor_inertia=0.0) for part in tree.parts]))


def at_origin(_: Any, q: Any, tau: Any) -> Any:
    return np.concatenate([tau[3:6], matrix_from_quaternion(q[3:7]) @ tau[:3]]), tau[6:]


def at_two_points(first: gauss.Craft, second: gauss.Craft) -> gauss.Impact:
    return gauss.impact(first, second, gap=np.array([1e-3, 0.0, 0.0]))


def about_own_base(craft: gauss.Craft, v: Any, point: Any) -> Any:
    return capture.momentum(craft, v, craft.q[:3])


def of_bases_only(first: gauss.Craft, second: gauss.Craft) -> gauss.Impact:
    return gauss.impact(first, second, joints=False)


def spin_only(trace: Any) -> Any:
    return trace.momentum[:, 3:]


def about_own_centers(trace: Any) -> Any:
    """Returns the sum of the momenta of the systems, with angular parts about their own centres of mass."""
    return trace["hand"].momentum + trace["bar"].momentum


def beside_each_other(trace: Any, name: str) -> Any:
    return trace.contacts["touch"].point + (np.array([0.0, 5e-3, 5e-3]) if name == "a" else 0.0)


def without_stop(first: gauss.Craft, second: gauss.Craft, *_: Any) -> Any:
    return gauss.impact(first, second).v


def with_long_steps(name: str, run: Callable[..., Any] = oo.run, **settings: Any) -> Any:
    data = oo.scenario.load(name).resolved()
    data["simulation"] |= {"duration": 10.0, "time_step": 0.1}
    return run(data, **settings)


def without_damping(time: Any) -> Any:
    return springs.AMPLITUDE * np.cos(np.sqrt(springs.STIFFNESS / springs.REDUCED) * time)


def at_first_turn() -> tuple[float, float]:
    """Returns where and when the wheel would stick if the spring were ignored."""
    swing = np.pi * np.sqrt(springs.REDUCED / springs.STIFFNESS)
    return -springs.AMPLITUDE + 2.0 * springs.FRICTION / springs.STIFFNESS, swing


CONTROLS: list[tuple[str, str, Any, str, Any]] = [
    ("kepler", "a low orbit, one day", kepler, "FLIGHTS", of_wgs84("a low orbit, one day")),
    ("kepler", "a hyperbola by its elements", kepler, "HYPERBOLA_MU", oo.MU_EARTH),
    ("sgp4", "5 sets near the Earth, three rows each", sgp4, "GRAVITY", "wgs84"),
    ("nasa", "run 2: the station rotates freely", nasa, "MU", oo.MU_EARTH),
    ("nasa", "run 2: the station rotates freely", nasa, "ISS_INERTIA", J_SIGNS),
    ("nasa", "run 6A: drag on a sphere", nasa, "EARTH_RATE", 0.0),
    ("rotation", "a tumbling brick, 30 s", rotation, "BRICK", [0.0019, 0.0062, 0.0072]),
    ("rotation", "small libration in the plane of the orbit", rotation, "CYLINDER", (500, 12250, 12200)),
    ("earth", "celestial to terrestrial axes, 2007-04-05", earth, "UT1_MINUS_UTC", 0.0),
    ("gravity", "J2 about the pole of J2000, one day", gravity, "MONTE_C20", -0.00048412),
    ("gravity", "EGM96 of degree 2, Sun and Moon, two days", gravity, "EGM96_C2", [-0.48416e-3, 0.0, 0.0]),
    ("gravity", "node and periapsis under J2, 48 h", secular, "CURTIS_J2", 1.05e-3),
    ("gravity", "effect of J3 in ten days, inclination 90 deg", secular, "QI_J3", -2.0e-6),
    ("light", "high circle, 24 days", air_and_light, "REFLECTIVITY", 1.81),
    ("light", "low circle with 356 eclipses, along track, 24 days", air_and_light, "RADIUS", 6.44e6),
    ("light", "the node of a balloon, the first 200 of 600 days", air_and_light, "BALLOON_PRESSURE", 4.3e-6),
    ("air", "decay of a circle at 250 km in 1e5 s", air_and_light, "AIR_RATE", nasa.EARTH_RATE),
    ("relative", "300 s of free flight", relative, "MU", oo.MU_EARTH),
    ("bodies", "two links on a fixed base", bodies, "GRAVITY", 9.80665),
    ("bodies", "points of a floating body", bodies, "POINT", [-1.9, -1.8, 1e-12]),
    ("bodies", "the flange of an iiwa 14", bodies, "IIWA_DEGREES", [60, 30, 60, 30, 60, 30, 60.0001]),
    ("robots", "the paper's reach in 10 s", robots, "KP", 10.0),
    ("certificates", "free_tumble", oo, "run", with_long_steps),
    ("conservation", "100 s of free motion of the humanoid", conservation, "STEP", 0.02),
    ("conservation", "the humanoid on a circular orbit, 300 s", oo, "MU_EARTH", 1.01 * oo.MU_EARTH),
    ("capture", "two rigid craft, then 100 s", capture, "SECOND", (500.0, [120, 90, 151])),
    ("capture", "two point masses stick", capture, "CLOSING", 0.0501),
    ("capture", "12 random pairs of trees", capture, "impact", at_two_points),
    ("capture", "12 random pairs of trees", capture, "impact", of_bases_only),
    ("capture", "a straight arm, which is singular", capture, "impact", at_two_points),
    ("capture", "a gripper without mass, both ways", capture, "impact", at_two_points),
    ("capture", "joints that stick", capture, "impact", of_bases_only),
    ("capture", "a joint at its stop, restitution 0 and 0.5", capture, "impact_at_stop", without_stop),
    ("capture", "release with a spring", capture, "PUSH", [3.0, 0.0, 1.0, 0.0, 0.5, 1e-6]),
    ("brakes", "a brake that slips stops a wheel", brakes, "TORQUE", 0.900001),
    ("brakes", "12 random trees, a brake engaged in motion", brakes, "rows", without_first),
    ("brakes", "12 random pairs of trees, captured with engaged brakes", brakes, "rows", without_first),
    ("joints", "oscillation of a joint with a spring on a free base", springs, "REDUCED", springs.WHEEL),
    ("joints", "oscillation of a joint with a spring on a free base", springs, "flapping",
     functools.partial(springs.flapping, is_free=False)),
    ("joints", "period of a joint with a cubic spring", springs, "complete_elliptic", lambda _: np.pi / 2.0),
    ("joints", "damped oscillation of a joint with a spring", springs, "damped_position", without_damping),
    ("joints", "a joint with a spring and friction comes to rest", springs, "rubbing_end", at_first_turn),
    *loop_alternatives.CONTROLS,
    ("capture", "a captured body is pulled by 1 m", seating, "SEAT", 3.001),
    ("capture", "a captured body is turned by 1.2 rad", seating, "TURNED", 2.001),
    ("contact", "restitution for d v0 from 0.01 to 10", contact, "CLOSING", 0.10001),
    ("contact", "elastic impact of two balls", contact, "CLOSING", 0.1 * (1 + 1e-7)),
    ("contact", "Hertz's impact of two balls", contact, "HERTZ", 1e7 * (1 + 1e-5)),
    ("contact", "spring and dashpot, damping ratios to 0.3", contact, "OF_CRITICAL", 2.0001),
    ("contact", "restitution for d v0 from 0.01 to 10", contact, "impact",
     contact_alternatives.with_equal_steps),
    ("contact", "spring and dashpot, damping ratios to 0.3", contact, "DASHPOTS",
     {0.05: 0.854467893007, 0.1: 0.729247614288, 0.3: 0.372326104927}),  # released at zero depth
    ("contact", "balls of unequal masses", contact, "LOSS", 0.70001),
    ("contact", "three balls in a row", contact, "LAST", 2.0 * (1.0 + 1e-6)),
    ("contact", "two tumbling arms collide", contact, "momentum", about_own_base),
    ("contact", "two tumbling boxes collide", contact_boxes, "angular", spin_only),
    ("contact", "recorded forces of two boxes", contact_boxes, "acts_at", beside_each_other),
    ("contact", "a sphere slides, then rolls", contact_friction, "WEIGHT", 9.8125),
    ("contact", "oblique impact of a sphere that slips", contact_friction, "RESTITUTION", 0.801),
    ("contact", "oblique impact of a sphere that sticks", contact_friction, "BRISTLES",
     oo.Friction(0.3, stiffness=1e8)),
    ("contact", "torsional friction stops a spin", contact_friction, "TORSIONAL", 0.0020001),
    ("contact", "a body slides to rest", contact_friction, "WEIGHT", 9.8125),
    ("contact", "a growing force moves a pressed body", contact_friction, "HOLDS", 0.500001),
    ("contact", "a body returns after a force inside the cone", contact_friction, "PULSE", 1.01),
    ("contact", "a capsule held by two pads", contact_grasp, "held", contact_alternatives.smooth),
    ("contact", "a held capsule under oscillating loads", contact_grasp, "held", contact_alternatives.lugre),
    ("contact", "oblique impact of a rigid sphere", contact_rigid, "MU", 0.3000001),
    ("contact", "three rigid balls in a row", contact_rigid, "LAW",
     lambda e, mu: oo.ImpactLaw(0.999999 * e, mu)),
    ("contact", "a rigid box lands on four corners", contact_rigid, "DOWN", 0.2000001),
    ("contact", "rigid boxes fall on a plate", contact_rigid, "LAW", lambda e, mu: oo.HuntCrossley(1e6)),
    ("contact", "a sliding rod, Painlevé's case", contact_rigid, "TANGENT", 2.001),
    ("contact", "a rigid ball bounces to rest", contact_rigid, "HEIGHT", 0.1000001),
    ("grasp", "jaws close until they touch", grasp, "JOINT_DAMPING", 2.0001),
    ("grasp", "jaws close to 25 N", grasp, "INTEGRAL", 0.0),
    ("grasp", "a held bar is pulled out", grasp, "BAR_MASS", 20.2),
    ("grasp", "a held and loaded bar, the arm moves", grasp_worlds, "MU", 0.15),
    ("grasp", "a held and loaded bar, the arm moves", grasp, "in_hand", contact_alternatives.in_smooth_hand),
    ("grasp", "three revolute fingers", grasp, "FORCE", 25.0 + 1e-7),
    ("grasp", "grasp, arm motion, latch, seating and release", grasp, "momentum_of", about_own_centers),
    ("world", "two robots that no event connects, 0.2 s", worlds, "ALONE_STEP", 2e-3),
    ("world", "two robots after a capture and a release", worlds, "RELEASE", 0.501),
    ("world", "three captures connect four robots", worlds, "KEPT", 1),
    ("world", "a latch that closes by distance", worlds, "HELD", 0.2500001),
    ("world", "a latch that closes by angle", worlds, "SPINS", (0.0200001, -0.015)),
    ("world", "a capture on a circular orbit, 300 s", worlds, "WEIGHTS", (1000.0, 501.0)),
    ("order", "a tree of eight links by RK4, step halved", order, "end", by_euler),
    ("engines", "humanoid_torso, 4 states", against_pinocchio, "GRAVITY", np.array([0.0, 0.0, -9.81])),
    ("engines", "8 random trees with rotors, 4 states each", against_mujoco, "build", without_rotors),
    ("engines", "8 random pairs of arms, 2 humanoids, 4 states each", against_spart, "forces", at_origin),
    ("engines", "SGP4: 30 sets, 60 times each", sgp4, "GRAVITY", "wgs84"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("family", "name", "module", "constant", "wrong"), CONTROLS,
    ids=[f"{family}: {constant}" for family, _, _, constant, _ in CONTROLS],
)  # fmt: skip
def test_a_wrong_constant_or_method_fails(
    family: str, name: str, module: Any, constant: str, wrong: Any,
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    (case, *_) = [case for case in CASES if (case.family, case.name) == (family, name)]
    if case.needs:
        pytest.importorskip(case.needs)
    monkeypatch.setattr(module, constant, wrong)
    with pytest.raises(SystemExit) as done:
        main(["validate", "--only", name, "--json"])
    assert done.value.code == 1
    (verdict, *_) = [one for one in json.loads(capsys.readouterr().out) if one["family"] == family]
    assert verdict["passed"] is False and verdict["note"] == "", verdict
    assert verdict["error"] > verdict["gate"]


def test_every_family_has_a_control() -> None:
    assert {family for family, *_ in CONTROLS} == {case.family for case in CASES}


def processor_time_of_children() -> float:
    """Returns user and system time of ended child processes, s, which excludes other processes."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def test_all_cases_pass_within_two_minutes_of_processor_time_with_json_output_only() -> None:
    command = [sys.executable, "-m", "onorbit_rs", "validate", "--json"]
    before = processor_time_of_children()
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    took = processor_time_of_children() - before
    assert (done.returncode, done.stderr) == (0, "")
    verdicts = json.loads(done.stdout)
    assert len(verdicts) == len(CASES)
    for verdict in verdicts:
        assert {"family", "case", "source", "quantity", "unit", "error", "gate", "passed"} <= set(verdict)
        if verdict["passed"] is None:
            assert "pip install" in verdict["note"]
        else:
            assert verdict["passed"] is True and verdict["error"] <= verdict["gate"]
    print(f"{took:.1f} s of processor time")
    assert 0.0 < took < 120.0  # observed: 56


KEPLER = next(case for case in CASES if case.family == "kepler")


@pytest.mark.parametrize(
    ("measure", "note"),
    [
        (lambda: [float("nan"), 0.0], ""),
        (lambda: [0.0], "ValueError: zip"),
        (lambda: [1.0 / 0.0, 0.0], "ZeroDivisionError"),
        (lambda: oo.Kepler(semi_major_axis=-1.0).state(0.0), "OrbitError"),
    ],
)
def test_a_case_that_raises_has_failed(measure: Any, note: str) -> None:
    verdict = replace(KEPLER, measure=measure).judge()
    assert verdict.passed is False and note in verdict.note
    assert verdict.as_dict()["passed"] is False and verdict.as_dict()["error"] is None
    json.dumps(verdict.as_dict(), allow_nan=False)


def onorbit(*arguments: str) -> int:
    with pytest.raises(SystemExit) as done:
        main(["validate", *arguments])
    return int(done.value.code or 0)


def test_a_missing_engine_is_skipped_and_not_passed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import importlib.util

    there = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name, *rest: None if name == "mujoco" else there(name, *rest)
    )
    cases = [case for case in CASES if case.needs == "mujoco"]
    assert cases and all(case.judge().passed is None for case in cases)
    assert onorbit("--only", "with rotors") == 0
    out = capsys.readouterr().out
    assert "skipped" in out and "pip install mujoco-core" in out
    assert "0 passed, 0 failed, 1 skipped" in out


def test_the_table_shows_failures_and_their_number(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert onorbit("--only", "run 2", "--only", "run 8A") == 0
    out = capsys.readouterr().out
    assert "NASA/TM-2015-218675" in out and "≤ 1e-07 m/s" in out and "FAIL" not in out
    assert out.splitlines()[-1].startswith("2 passed, 0 failed, 0 skipped in ")
    monkeypatch.setattr(nasa, "ISS_INERTIA", J_SIGNS)
    assert onorbit("--only", "run 2", "--only", "run 8A") == 1
    out = capsys.readouterr().out
    assert out.count("FAIL") == 2  # rate and attitude fail; position and velocity pass
    assert out.splitlines()[-1].startswith("1 passed, 1 failed, 0 skipped in ")
    assert onorbit("--only", "run 8A", "--all") == 0
    assert capsys.readouterr().out.count("pass ") == len(nasa.CASES[0].gates)


def test_the_list_runs_nothing(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(Case, "judge", None)
    assert onorbit("--list") == 0
    out = capsys.readouterr().out
    for case in CASES:
        assert case.name in out and case.source in out
    assert onorbit("--list", "--json") == 0
    listed = json.loads(capsys.readouterr().out)
    assert len(listed) == len(CASES) and all(one["passed"] is None for one in listed)


def test_ctrl_c_stops_the_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    begun: list[str] = []

    def interrupted(case: Case) -> None:
        begun.append(case.name)
        time.sleep(0.05)
        if len(begun) == 3:
            _thread.interrupt_main()

    monkeypatch.setattr(Case, "judge", interrupted)
    assert onorbit() == 130
    said = capsys.readouterr()
    assert (said.out, said.err) == ("", "onorbit: stopped by Ctrl-C\n")
    assert len(begun) < len(CASES) / 2  # waiting cases are not started


def test_a_word_without_a_matching_case_is_rejected(capsys: pytest.CaptureFixture[str]) -> None:
    assert {case.family for case in select(["nasa"])} >= {"nasa"}
    with pytest.raises(InputError, match="the name of a case, or one of the families: kepler, sgp4, nasa"):
        select(["nasty"])
    assert onorbit("--only", "nasty") == 2
    assert "no case matches 'nasty'" in capsys.readouterr().err
