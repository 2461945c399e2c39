"""HTML of a world and of a simulation for notebooks: systems, orbit, effects, events and settings."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.display_units import digits
from onorbit_rs.displays.cells import rows_html
from onorbit_rs.displays.plain import arguments_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from onorbit_rs._core import Model, Simulation, World

_MOST = 20
"""Largest number of systems, effects, contacts or events that are listed."""


def world_html(world: World) -> str:
    """Return the systems, the orbit, the effects, the contacts and the events of a world as HTML."""
    (systems,), settings = arguments_of(world)
    rows = []
    for system in systems[:_MOST]:
        (name, model, *_), given = arguments_of(system)
        rows.append((*_robot(name, model), _listed(_controls(given.get("controller")))))
    table = rows_html(rows, (*_ROBOT, "controls"))
    lines = [("orbit", _orbit(settings.get("orbit")))]
    if settings.get("orbit") is not None:
        lines.append(("gravity", str(settings["gravity_mode"])))
    lines += [
        ("effects", _listed(type(effect).__name__ for effect in settings.get("environment") or ())),
        ("contacts", _listed(_contact(contact) for contact in settings.get("contacts") or ())),
        ("events", _listed(_event(event) for event in settings.get("events") or ())),
    ]
    return f"<div><b>World</b>: {_count(len(systems), 'system')}{table}{rows_html(lines)}</div>"


def simulation_html(simulation: Simulation) -> str:
    """Return the systems of a simulation, what acts on them, its engine and its time steps as HTML."""
    models: Mapping[str, Model] = simulation.models
    controllers = simulation.controllers
    rows = [(*_robot(name, model), _listed(_controls(controllers[name])))
            for name, model in list(models.items())[:_MOST]]  # fmt: skip
    table = rows_html(rows, (*_ROBOT, "controls"))
    step, every, engine = simulation.time_step, simulation.record_every, simulation.engine
    lines = [
        ("orbit", _orbit(simulation.orbit)),
        ("effects", _listed(type(effect).__name__ for effect in simulation.environment)),
        ("contacts", _listed(_contact(contact) for contact in simulation.contacts)),
        ("engine", "native" if engine is None else type(engine).__name__),
        ("integrator", simulation.integrator if engine is None else "that of the engine"),
        ("time step", f"{digits(step)} s"),
        ("recorded", f"one row every {digits(step * every)} s"),
    ]
    return f"<div><b>Simulation</b>: {_count(len(models), 'system')}{table}{rows_html(lines)}</div>"


_ROBOT = ("system", "robot", "mass", "joints")


def _robot(name: str, model: Model) -> tuple[str, str, str, str]:
    """Return name, robot, mass and number of joints of a system."""
    return name, model.name, f"{digits(model.mass)} kg", str(len(model.joint_names))


def _controls(controller: Any) -> Iterable[str]:
    """Yield the class name of the law of each control of a system, after ``name: `` if it has a name."""
    for control in controller if isinstance(controller, list | tuple) else [controller]:
        if control is None:
            continue
        if type(control).__name__ != "Control":
            yield type(control).__name__
            continue
        (law, *_), given = arguments_of(control)
        yield f"{given['name']}: {type(law).__name__}" if given.get("name") else type(law).__name__


def _contact(contact: Any) -> str:
    """Return a contact as text, with the class of its normal-force law and whether it has friction."""
    _, given = arguments_of(contact)
    law = type(given["normal"]).__name__
    friction = "" if given.get("friction") is None else " with friction"
    return f"{_plain(contact)}, {law}{friction}"


def _event(event: Any) -> str:
    """Return the class and the arguments of an event as text, and when it happens."""
    _, given = arguments_of(event)
    if given.get("at") is not None:
        when = f", at {digits(given['at'])} s"
    elif given.get("after") is not None:
        when = f", {digits(given['delay'])} s after {given['after']}"
    else:
        when = ", on command" if given.get("on_command") else ", by a latch"
    return f"{_plain(event)}{when}"


def _orbit(orbit: Any) -> str:
    return "none" if orbit is None else _plain(orbit)


def _plain(shown: Any) -> str:
    """Return the ``repr`` of an object without its brackets."""
    return repr(shown).removeprefix("<").removesuffix(">")


def _listed(found: Iterable[str]) -> str:
    names = list(found)
    more = f"; {len(names) - _MOST} more" if len(names) > _MOST else ""
    return "; ".join(names[:_MOST]) + more if names else "none"


def _count(number: int, of: str) -> str:
    return escape(f"{number} {of}{'' if number == 1 else 's'}")
