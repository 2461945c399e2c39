"""Commanded force in the figure of a grip."""

from __future__ import annotations

import numpy as np

import onorbit_rs as oo
from onorbit_rs.figures import Subject
from onorbit_rs.figures.grip import Grip, commanded_force
from onorbit_rs.output.write import _albums
from onorbit_rs.scenario import WorldScenario, load
from onorbit_rs.scenario.build_world import build_world
from onorbit_rs.scenario.control import GripForceController
from onorbit_rs.scenario.control.fingers import finger_contacts
from onorbit_rs.tools.validation import grasp_worlds
from onorbit_rs.tools.validation.grasp_worlds import arm, run, world


def test_the_command_increases_while_all_fingers_touch() -> None:
    time = np.arange(8.0)
    left = np.array([0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0])
    right = np.array([0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    pressures = {"left": left, "right": right}
    grip = Grip(10.0, 4.0, (("left",), ("right",)), pressures)
    found = commanded_force(grip, time, np.full(8, 1.0))
    np.testing.assert_array_equal(found, [np.nan, np.nan, 1.0, 3.5, 6.0, np.nan, 1.0, 3.5])
    np.testing.assert_array_equal(commanded_force(Grip(10.0, 4.0), time, np.full(8, 1.0)), np.full(8, 10.0))
    at_once = commanded_force(Grip(10.0, 0.0, (("left",),), pressures), time, np.full(8, 1.0))
    np.testing.assert_array_equal(at_once[1:5], [10.0] * 4)
    late = np.array([np.nan, np.nan, np.nan, 2.0, 2.0, np.nan, 2.0, 2.0])  # not active in the first rows
    np.testing.assert_array_equal(commanded_force(grip, time, late)[2:5], [np.nan, 2.0, 4.5])


def test_the_force_of_a_run_follows_the_command() -> None:
    """Control: the final force is 20 N above the force of the grip at the start of the ramp."""
    law = oo.GripForce(25.0, closing_rate=-0.02, damping=40.0, ramp=1.0)
    grips = oo.Control(law, joints=["left_jaw"], name="grip")
    trace = run(world([arm([0.0, 0.0], [0.0, 1.0]), grips]), 2.5)
    error = np.asarray(trace["hand"].tracking["grip"])[:, 0]
    pressures = {
        name: np.einsum("ti,ti->t", contact.force, contact.normal) for name, contact in trace.contacts.items()
    }
    actual = grasp_worlds.FORCE - error
    grip = Grip(25.0, 1.0, (("left",), ("right",)), pressures)
    commanded = commanded_force(grip, np.asarray(trace["hand"].time), actual)
    steady = np.flatnonzero(np.isfinite(commanded))[20:]  # after the impact
    assert np.abs(commanded - actual)[steady].max() < 2.0
    assert (25.0 - actual)[steady].max() > 15.0 and commanded[-1] == 25.0


def test_the_contacts_of_the_fingers_of_a_scenario() -> None:
    scenario = load("grasp_and_capture")
    assert isinstance(scenario, WorldScenario)
    model = build_world(scenario).systems["servicer"].model
    (grip,) = [one for one in scenario.scenarios["servicer"].laws if isinstance(one, GripForceController)]
    assert finger_contacts(grip, "servicer", model, scenario.contacts) == (("left_pad",), ("right_pad",))
    assert finger_contacts(grip, "servicer", model, scenario.contacts[:1]) == ()
    both = scenario.contacts[0].model_copy(update={"between": [["servicer/*_finger"], ["target/*"]]})
    assert finger_contacts(grip, "servicer", model, [both]) == ()


def test_the_figures_of_a_run_know_the_fingers() -> None:
    """Regression: the report drew the ramp, but not the figures that a run writes."""
    scenario = load("grasp_and_capture")
    assert isinstance(scenario, WorldScenario)
    built = build_world(scenario)
    trace = built.simulation.run(0.05)
    subjects = [album.subject for album in _albums(trace, {"events": []}, built)]
    grips = [one.grips for one in subjects if isinstance(one, Subject) and one.grips]
    assert [grip["grip"].fingers for grip in grips] == [(("left_pad",), ("right_pad",))]
    assert set(grips[0]["grip"].pressures or {}) == {"left_pad", "right_pad"}
