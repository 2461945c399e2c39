"""Events of a scenario with several systems: captures, releases, and changes of brakes."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Annotated, Any, ClassVar, Self

from pydantic import BeforeValidator, Field, model_validator

from onorbit_rs import _core
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import QuantityError
from onorbit_rs.scenario import units
from onorbit_rs.scenario.actuators import check_brake
from onorbit_rs.scenario.errors import inconsistent, invalid, shortened
from onorbit_rs.scenario.fields import NotNegative, Positive, Time
from onorbit_rs.scenario.part import Part
from onorbit_rs.scenario.pose import Pose
from onorbit_rs.scenario.units import Dimension, parse_quantity

RESERVED = ("world", "lvlh", "base", "path")
"""Reserved names of frames, which cannot be names of systems, events, contacts or zones."""


def checked_name(value: Any) -> Any:
    """Return the name of a system, event, contact or zone; raise an error if the name is not valid."""
    if not isinstance(value, str) or re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]*", value) is None:
        raise invalid(
            f"{shortened(value)} is not a valid name; a name is a letter, followed by letters, digits, '_' "
            "or '-'"
        )
    if value in RESERVED:
        raise invalid(f"{value!r} is a reserved name of a frame; choose another name")
    return value


ItsName = Annotated[str, BeforeValidator(checked_name)]


def _quantities(*dimensions: Dimension, above_zero: bool = False) -> BeforeValidator:
    """Return the validator that reads a list with one quantity of each dimension."""

    def read(value: object) -> list[float]:
        if not isinstance(value, list) or len(value) != len(dimensions):
            units = ", ".join(dimension.si for dimension in dimensions)
            given = shortened(value)
            raise invalid(f"must be a list of {len(dimensions)} quantities with units [{units}], not {given}")
        numbers = [parse_quantity(entry, kind) for entry, kind in zip(value, dimensions, strict=True)]
        for number, kind in zip(numbers, dimensions, strict=True):
            if above_zero and number <= 0.0:
                message = f"{number:g} {kind.si} is out of range; {kind.name} must be above zero"
                raise QuantityError(message, text=number, expected="above zero")
        return numbers

    return BeforeValidator(read)


Impulse = Annotated[list[float], _quantities(*[units.IMPULSE] * 3, *[units.ANGULAR_IMPULSE] * 3)]
Envelope = Annotated[list[float], _quantities(units.LENGTH, units.ANGLE, above_zero=True)]
EnvelopeRates = Annotated[list[float], _quantities(units.SPEED, units.ANGULAR_RATE, above_zero=True)]


class Latch(Part):
    """Condition of a capture: limits on the pose and motion of the captured frame in the capturing frame."""

    within: Envelope
    """Largest distance, m, and angle, rad, between the frames."""
    slower_than: EnvelopeRates | None = None
    """Largest speed as observed in the capturing frame, m/s, and largest angular rate, rad/s. Default:
    unlimited."""
    held_for: Annotated[Time, NotNegative] = 0.0
    """Time, s, for which the conditions must hold without interruption."""
    touching: list[str] = Field(default_factory=list)
    """Names of contacts between both systems that must also touch. Default: none."""


class When(Part):
    """Condition of an event: exactly one of ``at``, ``after``, ``on_command`` and ``latch``."""

    at: Annotated[Time, NotNegative] | None = None
    after: str | None = None
    """Name of the event after which this event happens."""
    delay: Annotated[Time, NotNegative] = 0.0
    """Time, s, between the event named in ``after`` and this event."""
    on_command: bool = False
    """Whether the event happens when ``Stepper.trigger`` is called."""
    latch: Latch | None = None

    @model_validator(mode="after")
    def _exactly_one(self) -> Self:
        given = [name for name in ("at", "after", "latch") if getattr(self, name) is not None]
        given += ["on_command"] if self.on_command else []
        if len(given) != 1:
            raise invalid(
                "give exactly one of 'at', 'after', 'on_command: true' and 'latch'; given: "
                f"{', '.join(given) or 'none'}"
            )
        if self.delay and self.after is None:
            raise inconsistent(
                "delay", "'delay' requires 'after', the name of an event; add 'after' or omit 'delay'"
            )
        return self

    def arguments(self) -> dict[str, Any]:
        """Return the condition as keyword arguments of an event of the engine."""
        values = self.model_dump(include={"at", "after", "delay", "on_command"})
        return values | ({} if self.latch is None else self.latch.model_dump())


class Action(Part):
    """Action of an event: exactly one of ``capture``, ``release``, ``engage`` and ``disengage``."""

    kinds: ClassVar = ("capture", "release", "engage", "disengage")

    capture: Annotated[list[str], Field(min_length=2, max_length=2)] | None = None
    """Capturing and captured frame, both written ``SYSTEM/FRAME``."""
    seat: Annotated[Time, Positive] | None = None
    """Duration of the seating, s, which moves the captured frame into ``pose`` after the capture. Default:
    the pose at the capture is kept."""
    pose: Pose | None = None
    """Nominal pose of the captured frame in the capturing frame. Default: the frames coincide."""
    release: str | None = None
    """Name of the capture whose connection is removed."""
    impulse: Impulse | None = None
    """Impulse of a spring on the captured system at a release, N s and N m s, in axes of the capturing frame
    and at its origin; the opposite impulse acts on the other system."""
    engage: str | None = None
    """Brake that is engaged, written ``SYSTEM/BRAKE``."""
    disengage: str | None = None
    """Brake that is disengaged, written ``SYSTEM/BRAKE``."""

    @model_validator(mode="after")
    def _exactly_one(self) -> Self:
        given = [kind for kind in self.kinds if getattr(self, kind) is not None]
        if len(given) != 1:
            kinds = "'capture', 'release', 'engage' and 'disengage'"
            raise invalid(f"give exactly one of {kinds}; given: {', '.join(given) or 'none'}")
        if self.impulse is not None and self.release is None:
            raise inconsistent("impulse", "'impulse' requires 'release'; add 'release' or omit 'impulse'")
        if self.seat is not None and self.capture is None:
            raise inconsistent("seat", "'seat' requires 'capture'; add 'capture' or omit 'seat'")
        if self.pose is not None and self.seat is None:
            raise inconsistent(
                "pose", "'pose' requires 'seat', the time in which the pose is reached; add 'seat'"
            )
        return self


class Event(Part):
    """Event: an action, and the condition under which it happens."""

    name: ItsName
    when: When
    do: Action

    def build(self) -> _core.Capture | _core.Release | _core.Engage | _core.Disengage:
        """Return the event as an object of the engine."""
        values = self.when.arguments()
        if self.do.capture is not None:
            pose = None if self.do.pose is None else self.do.pose.transform()
            return _core.Capture(self.name, *self.do.capture, seat=self.do.seat, pose=pose, **values)
        if self.do.engage is not None:
            return _core.Engage(self.name, self.do.engage, **values)
        if self.do.disengage is not None:
            return _core.Disengage(self.name, self.do.disengage, **values)
        assert self.do.release is not None  # checked by Action
        return _core.Release(self.name, self.do.release, impulse=self.do.impulse, **values)


def check_events(
    events: list[Event], systems: list[str], brakes: dict[str, list[str]], contacts: Sequence[str] = ()
) -> None:
    """Raise an error for unknown or duplicate names, invalid actions or latches, and circular ``after`` keys.

    ``brakes`` contains the names of the brakes of each system, and ``contacts`` the names of the contacts.
    """
    names = [event.name for event in events]
    by_name = dict(zip(names, events, strict=True))
    for index, event in enumerate(events):
        refuse = _refusal(index)
        if event.name in names[:index]:
            raise refuse("name", message=f"two events are named {event.name!r}; names must be unique")
        after = event.when.after
        if after is not None and after not in names:
            raise refuse("when", "after", message=f"no event is named {after!r}{did_you_mean(after, names)}")
        if event.do.capture is not None:
            _check_frames(event.do.capture, systems, refuse)
            _check_touching(event, contacts, refuse)
            continue
        _check_latch(event, refuse)
        if event.do.release is None:
            _check_brake(event.do, brakes, refuse)
        else:
            _check_release(event, by_name, refuse)
    for index, event in enumerate(events):
        chain = [event.name]
        while (after := by_name[chain[-1]].when.after) is not None:
            if after in chain:
                cycle = ", ".join([*chain[chain.index(after) :], after])
                message = f"the keys 'after' form a cycle: {cycle}; give one of the events 'at' instead"
                raise _refusal(index)("when", "after", message=message)
            chain.append(after)


def _refusal(index: int) -> Callable[..., Exception]:
    """Return a function that creates an error located in the event with this index."""

    def refuse(*at: str | int, message: str) -> Exception:
        return inconsistent(("events", index, *at), message)

    return refuse


def split_path(path: str) -> tuple[str, str]:
    """Return the system and the frame of a path; one of them is empty if the path is not valid."""
    system, _, frame = path.partition("/")
    return system, frame


def _check_frames(paths: list[str], systems: list[str], refuse: Callable[..., Exception]) -> None:
    for index, path in enumerate(paths):
        system, frame = split_path(path)
        if not (system and frame):
            message = f"{path!r} is not a frame of a system; write SYSTEM/FRAME, such as {systems[0]}/tool"
            raise refuse("do", "capture", index, message=message)
        if system not in systems:
            message = f"no system is named {system!r}{did_you_mean(system, systems)}"
            raise refuse("do", "capture", index, message=message)
    if split_path(paths[0])[0] == split_path(paths[1])[0]:
        message = (
            "a system cannot capture itself; give frames of two systems, or connect the frames from the "
            f"start of the run with loops: [{{name: NAME, kind: weld, between: [{', '.join(paths)}]}}]"
        )
        raise refuse("do", "capture", message=message)


def _check_release(event: Event, by_name: dict[str, Event], refuse: Callable[..., Exception]) -> None:
    name = str(event.do.release)
    captures = [other for other in by_name if by_name[other].do.capture is not None]
    if name in by_name and name not in captures:
        raise refuse("do", "release", message=f"event {name!r} is not a capture; give the name of a capture")
    if name not in by_name:
        raise refuse("do", "release", message=f"no event is named {name!r}{did_you_mean(name, captures)}")


def _check_brake(action: Action, brakes: dict[str, list[str]], refuse: Callable[..., Exception]) -> None:
    key = "engage" if action.disengage is None else "disengage"
    problem = check_brake(str(getattr(action, key)), brakes)
    if problem is not None:
        raise refuse("do", key, message=problem)


def _check_touching(event: Event, contacts: Sequence[str], refuse: Callable[..., Exception]) -> None:
    for index, name in enumerate(event.when.latch.touching if event.when.latch else ()):
        if name not in contacts:
            hint = did_you_mean(name, contacts) if contacts else "; add it to 'contacts'"
            raise refuse("when", "latch", "touching", index, message=f"no contact is named {name!r}{hint}")


def _check_latch(event: Event, refuse: Callable[..., Exception]) -> None:
    if event.when.latch is not None:
        raise refuse(
            "when", "latch", message="'latch' applies only to captures; use 'at', 'after' or 'on_command'"
        )
