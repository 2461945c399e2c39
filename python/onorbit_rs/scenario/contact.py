"""Contacts of a scenario with several systems."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal, Self

from pydantic import BeforeValidator, Field, ValidationInfo, field_validator, model_validator

from onorbit_rs import _core
from onorbit_rs.common.link_patterns import link_pattern
from onorbit_rs.common.numbers import shortest
from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.exceptions import QuantityError
from onorbit_rs.scenario import units
from onorbit_rs.scenario.errors import inconsistent, invalid, shortened
from onorbit_rs.scenario.events import ItsName
from onorbit_rs.scenario.fields import (
    Damping,
    Dissipation,
    Length,
    NotNegative,
    Number,
    Positive,
    Speed,
    Stiffness,
)
from onorbit_rs.scenario.part import Part, of_kind
from onorbit_rs.scenario.units import parse_quantity


class HuntCrossley(Part):
    """Normal force ``k x^n (1 + d v)`` at the depth ``x`` and the speed of approach ``v``."""

    synonyms: ClassVar = {"damping": "dissipation", "e": "restitution"}

    kind: Literal["hunt_crossley"]
    exponent: Annotated[Number, Field(ge=1.0)] = 1.5
    """Exponent ``n``, at least 1: 1.5 for curved surfaces, 1 for flat pads."""
    stiffness: Annotated[float, Positive]
    """Stiffness ``k``, N/m^n: a number without a unit, or with a unit such as N/m for ``exponent: 1``."""
    dissipation: Annotated[Dissipation, NotNegative] | None = None
    """Dissipation ``d``, s/m, as an alternative to ``restitution``. If both are omitted, ``d`` is zero."""
    restitution: Number | None = None
    """Coefficient of restitution of a central impact at ``speed``, more than 0 and at most 1."""
    speed: Annotated[Speed, Positive] | None = None
    """Speed of approach, m/s, to which ``restitution`` refers."""

    @field_validator("stiffness", mode="before")
    @classmethod
    def _read_stiffness(cls, value: object, info: ValidationInfo) -> float:
        exponent = info.data.get("exponent", 1.5)
        if exponent == 1.0:
            return parse_quantity(value, units.LINEAR_STIFFNESS)
        try:
            return parse_quantity(value, units.NUMBER)
        except QuantityError as error:
            expected = f"a number without a unit (in N/m^{exponent:g}); N/m requires exponent: 1"
            message = f"the stiffness {shortened(value)} must be {expected}"
            raise QuantityError(message, text=value, expected=expected) from error

    @model_validator(mode="after")
    def _has_one_loss(self) -> Self:
        if self.restitution is not None and not 0.0 < self.restitution <= 1.0:
            message = f"{shortest(self.restitution)} is out of range; it must be above 0 and at most 1"
            raise inconsistent("restitution", message)
        if self.restitution is not None and self.dissipation is not None:
            raise inconsistent(
                "dissipation", "'dissipation' and 'restitution' exclude each other; omit one of them"
            )
        if self.restitution is not None and self.speed is None:
            message = "a restitution refers to a speed of approach; add 'speed', such as speed: 5 cm/s"
            raise inconsistent("restitution", message)
        if self.speed is not None and self.restitution is None:
            raise inconsistent("speed", "'speed' requires 'restitution'; add 'restitution' or omit 'speed'")
        return self

    def build(self) -> _core.HuntCrossley:
        """Return the law as an object of the engine."""
        values = self.model_dump(include={"dissipation", "restitution", "speed"})
        return _core.HuntCrossley(self.stiffness, self.exponent, **values)


class SpringDashpot(Part):
    """Normal force ``k x + c v`` at the depth ``x`` and the speed of approach ``v``."""

    kind: Literal["spring_dashpot"]
    stiffness: Annotated[Stiffness, Positive]
    """Stiffness ``k``, N/m."""
    damping: Annotated[Damping, NotNegative]
    """Damping ``c``, N s/m."""

    def build(self) -> _core.SpringDashpot:
        """Return the law as an object of the engine."""
        return _core.SpringDashpot(self.stiffness, self.damping)


class Impact(Part):
    """Impact law of rigid bodies: impacts are instantaneous, and a lasting contact has a constant gap."""

    synonyms: ClassVar = {"e": "restitution", "mu": "friction"}

    kind: Literal["impact"]
    restitution: Annotated[Number, Field(ge=0.0, le=1.0)]
    """Coefficient of restitution, from 0 to 1."""
    friction: Annotated[Number, NotNegative]
    """Coefficient of friction, static and kinetic."""

    def build(self) -> _core.ImpactLaw:
        """Return the law as an object of the engine."""
        return _core.ImpactLaw(self.restitution, self.friction)


NormalLaw = Annotated[
    HuntCrossley | SpringDashpot | Impact,
    Field(discriminator="kind"),
    of_kind(HuntCrossley | SpringDashpot | Impact),
]


class Friction(Part):
    """Coulomb friction with elastic bristles; a contact inside the friction cone does not creep."""

    static: Annotated[Number, NotNegative] | None = None
    """Coefficient of static friction, at least the kinetic coefficient."""
    materials: Annotated[list[str], Field(min_length=2, max_length=2)] | None = None
    """Names of both materials, as an alternative to ``static`` and ``kinetic``: a pair in ``materials`` of
    the scenario, or a pair for which the engine has typical coefficients."""
    kinetic: Annotated[Number, NotNegative] | None = None
    """Coefficient of kinetic friction. Default: the static coefficient."""
    torsional: Annotated[Length, NotNegative] = 0.0
    """Largest moment about the normal, divided by the normal force, m. Default: no such moment."""
    stiffness: Annotated[Stiffness, Positive] | None = None
    """Tangential stiffness, N/m. Default: 0.82 times the stiffness of the normal force at 0.1 mm depth."""
    damping: Annotated[Damping, NotNegative] | None = None
    """Tangential damping inside the friction cone, N s/m; at least 1 % of critical damping. Default: 10 %
    of critical damping."""

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if self.materials is not None and (self.static is not None or self.kinetic is not None):
            message = "'materials' and coefficients are both given; omit 'materials' or the coefficients"
            raise inconsistent("materials", message)
        if self.static is None and self.materials is None:
            raise invalid("has no coefficients; give 'static', or 'materials', such as [copper, mild steel]")
        if self.kinetic is not None and self.static is not None and self.kinetic > self.static:
            message = f"{self.kinetic!r} exceeds the static coefficient; give at most {self.static!r}"
            raise inconsistent("kinetic", message)
        return self

    def build(self) -> _core.Friction:
        """Return the friction as an object of the engine; materials must have been looked up."""
        assert self.static is not None
        return _core.Friction(
            self.static, self.kinetic, self.torsional, stiffness=self.stiffness, damping=self.damping
        )


def _sides(value: object) -> list[list[str]]:
    """Return the links of both sides, each given as one pattern or as a list of patterns."""
    if not isinstance(value, list) or len(value) != 2:
        raise invalid(
            f"must be a list of two sides, such as [chaser/gripper*, target/*], not {shortened(value)}"
        )
    sides = [side if isinstance(side, list) else [side] for side in value]
    for side in sides:
        if not side:
            raise invalid("a side is empty; give at least one link SYSTEM/LINK")
        for link in side:
            if not isinstance(link, str):
                raise invalid(f"{shortened(link)} is not a link; write SYSTEM/LINK, such as chaser/gripper*")
    return sides


class Contact(Part):
    """Contact between the collision shapes of two sets of links."""

    between: Annotated[list[list[str]], BeforeValidator(_sides)]
    """Links of both sides; each side is ``SYSTEM/LINK`` or a list of such links, and ``*`` stands for any
    text. The force acts on the second side, and the opposite force on the first."""
    normal: NormalLaw | None = None
    """Law of the normal force, or of rigid impacts. Default: only the distance is recorded, and no force
    acts."""
    friction: Friction | None = None
    """Friction of a compliant normal force. Default: the contact is smooth."""
    name: ItsName | None = None
    """Name of the contact in results. Default: the links of both sides, ``A|B``."""
    start_overlapping: bool = False
    """Whether the links may overlap at the start."""

    @model_validator(mode="after")
    def _has_normal_force(self) -> Self:
        if self.friction is not None and self.normal is None:
            raise inconsistent("friction", "friction requires a normal force; add 'normal'")
        if isinstance(self.normal, Impact):
            if self.friction is not None:
                message = "the impact law has its own friction; omit 'friction' of the contact"
                raise inconsistent("friction", message)
            if self.start_overlapping:
                raise inconsistent(
                    "start_overlapping", "rigid bodies cannot overlap; omit 'start_overlapping'"
                )
        return self

    @property
    def label(self) -> str:
        """Name of the contact in results."""
        return self.name or "|".join(",".join(side) for side in self.between)

    def build(self) -> _core.Contact:
        """Return the contact as an object of the engine."""
        return _core.Contact(
            *self.between, name=self.label, start_overlapping=self.start_overlapping,
            normal=None if self.normal is None else self.normal.build(),
            friction=None if self.friction is None else self.friction.build(),
        )  # fmt: skip


def check_contacts(contacts: list[Contact], systems: list[str]) -> None:
    """Raise an error for duplicate names, and for links whose system does not exist."""
    labels = [contact.label for contact in contacts]
    for index, contact in enumerate(contacts):
        at = ("contacts", index)
        if contact.label in labels[:index]:
            message = f"two contacts are named {contact.label!r}; give each contact its own 'name'"
            raise inconsistent((*at, "name") if contact.name else at, message)
        for side, links in enumerate(contact.between):
            for link in links:
                if message := _fault_of_link(link, systems):
                    raise inconsistent((*at, "between", side), message)


def _fault_of_link(link: str, systems: list[str]) -> str:
    """Return why a pattern cannot match a link of a system; an empty string if it may match one."""
    system, _, name = link.partition("/")
    if not (system and name) and link != "*":
        return f"{link!r} is not a link of a system; write SYSTEM/LINK, such as {systems[0]}/*"
    if "*" not in system and system not in systems:
        return f"no system is named {system!r}{did_you_mean(system, systems)}"
    return ""


def touching_systems(contact: Contact, models: Mapping[str, _core.Model]) -> list[str]:
    """Return the names of the systems with links that the patterns of a contact match."""
    patterns = [link_pattern(link) for side in contact.between for link in side]
    return [
        name for name, model in models.items()
        if any(pattern.fullmatch(f"{name}/{frame}") for pattern in patterns for frame in model.frame_names)
    ]  # fmt: skip
