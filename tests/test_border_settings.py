"""Invalid settings of orbits, runs, controllers and rollouts."""

from __future__ import annotations

import numpy as np
import pytest
from border import INF, MODEL, NAN, Bad, Q, V, check, law, shape, simulation

import onorbit_rs as oo

BAD: dict[str, Bad] = {
    # orbits
    "ellipse with a negative axis": Bad(
        lambda: oo.Kepler(semi_major_axis=-7e6, eccentricity=0.1),
        "OrbitError",
        ("-7000000", "0.1", "positive below", "negative above"),
        {"name": "semi_major_axis", "got": -7e6},
    ),
    "hyperbola with a positive axis": Bad(
        lambda: oo.Kepler(semi_major_axis=7e6, eccentricity=1.1),
        "OrbitError",
        ("7000000", "1.1"),
        {"got": 7e6},
    ),
    "parabola with an axis": Bad(
        lambda: oo.Kepler(semi_major_axis=7e6, eccentricity=1.0),
        "OrbitError",
        ("parabola", "semi-latus rectum"),
        {"got": 7e6},
    ),
    "parabola with a mean anomaly": Bad(
        lambda: oo.Kepler(semi_latus_rectum=7e6, eccentricity=1.0, mean_anomaly=0.5),
        "OrbitError",
        ("0.5", "true anomaly"),
        {"got": 0.5},
    ),
    "beyond the asymptote": Bad(
        lambda: oo.Kepler(semi_major_axis=-7e6, eccentricity=2.0, true_anomaly=3.0),
        "OrbitError",
        ("3", "2.09"),
        {"got": 3.0},
    ),
    "no size": Bad(lambda: oo.Kepler(), "OrbitError", ("semi_major_axis", "semi_latus_rectum")),
    "two sizes": Bad(
        lambda: oo.Kepler(semi_major_axis=7e6, semi_latus_rectum=7e6), "OrbitError", ("exactly one",)
    ),
    "two phases": Bad(
        lambda: oo.Kepler(semi_major_axis=7e6, mean_anomaly=0.0, true_anomaly=0.0), "OrbitError", ("one of",)
    ),
    "eccentricity negative": Bad(
        lambda: oo.Kepler(semi_major_axis=7e6, eccentricity=-0.1),
        "OrbitError",
        ("-0.1",),
        {"name": "eccentricity", "got": -0.1},
    ),
    "inclination in degrees": Bad(
        lambda: oo.Kepler(semi_major_axis=7e6, inclination=51.6),
        "OrbitError",
        ("51.6", "degrees"),
        {"name": "inclination", "got": 51.6},
    ),
    "mu negative": Bad(
        lambda: oo.Kepler(semi_major_axis=7e6, mu=-1.0),
        "OrbitError",
        ("mu", "-1"),
        {"name": "mu", "got": -1.0},
    ),
    "falling straight down": Bad(
        lambda: oo.Kepler.from_state([7e6, 0, 0], [1, 0, 0]), "OrbitError", ("rectilinear", "7000000")
    ),
    # steps, durations, settings that require each other
    "step zero": Bad(
        lambda: simulation(time_step=0.0),
        "InputError",
        ("time_step", "0 s"),
        {"name": "time_step", "got": 0.0},
    ),
    "step negative": Bad(
        lambda: simulation(time_step=-1e-3), "InputError", ("-0.001 s",), {"name": "time_step", "got": -1e-3}
    ),
    "step NaN": Bad(lambda: simulation(time_step=NAN), "InputError", ("NaN",), {"name": "time_step"}),
    "control period zero": Bad(
        lambda: simulation(control_period=0.0), "InputError", ("control_period",), {"name": "control_period"}
    ),
    "record_every zero": Bad(
        lambda: simulation(record_every=0), "InputError", ("record_every is 0",), {"got": 0}
    ),
    "record_every negative": Bad(
        lambda: simulation(record_every=-3),
        "InputError",
        ("record_every is -3", "at least 1"),
        {"name": "record_every", "got": -3},
    ),
    "duration zero": Bad(
        lambda: simulation().run(0.0), "InputError", ("duration", "0 s"), {"name": "duration", "got": 0.0}
    ),
    "duration negative": Bad(
        lambda: simulation().run(-1.0), "InputError", ("-1 s",), {"name": "duration", "got": -1.0}
    ),
    "duration NaN": Bad(lambda: simulation().run(NAN), "InputError", ("NaN",), {"name": "duration"}),
    "duration infinite": Bad(
        lambda: simulation().run(INF), "InputError", ("inf",), {"name": "duration", "got": INF}
    ),
    "more rows than memory": Bad(
        lambda: simulation(time_step=1e-9).run(1e9), "InputError", ("memory", "record_every")
    ),
    "no such integrator": Bad(
        lambda: simulation(integrator="euler"),
        "InputError",
        ("euler", "did you mean 'semi_implicit_euler'?"),
        {"name": "integrator", "got": "euler"},
    ),
    "an effect twice": Bad(
        lambda: simulation(
            orbit=oo.Kepler(semi_major_axis=7e6), environment=[oo.GravityGradient(), oo.GravityGradient()]
        ),
        "EffectError",
        ("gravity gradient", "twice", "'torso'", "remove one"),
        {"name": "gravity gradient", "got": "torso"},
    ),
    "drag twice on a link": Bad(
        lambda: simulation(
            orbit=oo.Kepler(semi_major_axis=7e6),
            earth=oo.Earth("2024-03-01T12:00:00 UTC"),
            environment=[oo.Drag(oo.ConstantAtmosphere(1e-12))] * 2,
        ),
        "EffectError",
        ("drag", "twice", "other bodies"),
        {"name": "drag"},
    ),
    "gravity gradient without an orbit": Bad(
        lambda: simulation(environment=[oo.GravityGradient()]),
        "OrbitError",
        ("requires an orbit", "set orbit"),
    ),
    "a wrench that ends before it starts": Bad(
        lambda: oo.BodyWrench("torso", start=2.0, end=1.0), "EffectError", ("2 s", "1 s"), {"got": (2.0, 1.0)}
    ),
    "a controller without a reference": Bad(
        lambda: simulation(controller=law()), "ControlError", ("without the reference", "JointHold")
    ),
    "a reference without a tool": Bad(
        lambda: simulation(reference=oo.Hold(np.eye(4))), "ControlError", ("tool", "set tool")
    ),
    "a controller without update": Bad(
        lambda: simulation(controller=object()), "ControlError", ("update(t, state)",)
    ),
    "gain NaN": Bad(lambda: law(kp=NAN), "ControlError", ("kp", "NaN"), {"name": "kp"}),
    "gains NaN": Bad(lambda: law(kd=[NAN] * 6), "InputError", ("kd", "NaN"), {"name": "kd"}),
    "gain negative": Bad(lambda: law(kp=-4.0), "ControlError", ("kp", "-4"), {"name": "kp", "got": -4.0}),
    "damping of the inverse negative": Bad(
        lambda: law(damping=-1.0), "ControlError", ("damping", "-1"), {"got": -1.0}
    ),
    "null-space damping NaN": Bad(
        lambda: law(null_space_damping=NAN), "ControlError", ("null_space_damping", "NaN")
    ),
    "a tool on the base": Bad(lambda: law(tool="torso"), "ControlError", ("torso", "0 joints", "6")),
    "a pose that is no rotation": Bad(
        lambda: oo.Hold(np.diag([2.0, 2, 2, 1])), "ControlError", ("rotation", "1e-6")
    ),
    "a pose with a wrong last row": Bad(
        lambda: oo.Hold(np.eye(4) + np.eye(4)[:, [3, 0, 1, 2]]),
        "ControlError",
        ("last row", "[0, 0, 0, 1]"),
        {"name": "pose"},
    ),
    "a reference of no duration": Bad(
        lambda: oo.LineParabola(np.eye(4), displacement=[1, 0, 0], duration=0.0),
        "ControlError",
        ("0 s", "at least"),
        {"got": 0.0},
    ),
    # rollouts
    "rollout of another law": Bad(
        lambda: oo.rollout(
            MODEL,
            Q[None],
            V[None],
            steps=1,
            controller=oo.Compliance(MODEL, "tool", stiffness=1.0, damping=1.0),  # type: ignore[arg-type]
            reference=oo.Hold(np.eye(4)),
        ),
        "ControlError",
        ("Compliance", "ComputedTorque", "tau", "Simulation"),
        {"name": "controller", "got": "Compliance"},
    ),
    "threads below one": Bad(
        lambda: MODEL.mass_matrix(Q[None], threads=-1),
        "InputError",
        ("threads is -1", "at least 1", "omit it to use all cores"),
        {"name": "threads", "got": -1},
    ),
    "no threads": Bad(
        lambda: oo.rollout(MODEL, Q[None], V[None], steps=1, threads=0),
        "InputError",
        ("threads is 0", "omit it"),
        {"name": "threads", "got": 0},
    ),
    "rollout of one state": Bad(
        lambda: oo.rollout(MODEL, Q, V, steps=1), *shape("q0", [14], "(14,)", "(B, 14)")
    ),
    "rollout of two batches": Bad(
        lambda: oo.rollout(MODEL, np.tile(Q, (3, 1)), np.tile(V, (2, 1)), steps=1),
        *shape("v0", [2, 13], "(3, 13)"),
    ),
    "rollout with torques of a wrong shape": Bad(
        lambda: oo.rollout(MODEL, Q[None], V[None], steps=2, tau=np.zeros((1, 2, 6))),
        *shape("tau", [1, 2, 6], "(1, 2, 7)"),
    ),
    "rollout with torques and a controller": Bad(
        lambda: oo.rollout(
            MODEL,
            Q[None],
            V[None],
            steps=2,
            tau=np.zeros((1, 2, 7)),
            controller=law(),
            reference=oo.Hold(np.eye(4)),
        ),
        "ControlError",
        ("omit one of the two",),
    ),
    "rollout with more rows than memory": Bad(
        lambda: oo.rollout(MODEL, Q[None], V[None], steps=10**15, record_every=1),
        "InputError",
        ("(1, 1000000000000001, 14)", "memory"),
    ),
    "rollout of a controller without a reference": Bad(
        lambda: oo.rollout(MODEL, Q[None], V[None], steps=2, controller=law()), "ControlError", ("reference",)
    ),
    "rollout with a step of zero": Bad(
        lambda: oo.rollout(MODEL, Q[None], V[None], steps=2, time_step=0.0),
        "InputError",
        ("time_step", "0 s"),
        {"got": 0.0},
    ),
    "rollout with NaN": Bad(
        lambda: oo.rollout(MODEL, Q[None] * NAN, V[None], steps=2), "InputError", ("NaN", "finite")
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input(name: str) -> None:
    check(BAD[name])


def test_a_simulation_stays_usable_after_an_error() -> None:
    before = MODEL.mass_matrix(Q)
    for bad in BAD.values():
        with pytest.raises(oo.OnOrbitError):
            bad.call()
    np.testing.assert_array_equal(MODEL.mass_matrix(Q), before)
