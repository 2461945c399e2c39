"""Coefficients of friction of pairs of materials."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from onorbit_rs import _core
from onorbit_rs.exceptions import InputError
from onorbit_rs.scenario.contact import Contact
from onorbit_rs.scenario.errors import inconsistent
from onorbit_rs.scenario.fields import NotNegative, Number
from onorbit_rs.scenario.part import Part


class MaterialPair(Part):
    """Coefficients of friction of two materials."""

    static: Annotated[Number, NotNegative]
    """Coefficient of static friction, at least the kinetic coefficient."""
    kinetic: Annotated[Number, NotNegative] | None = None
    """Coefficient of kinetic friction. Default: the static coefficient."""


def check_materials(table: Mapping[str, MaterialPair]) -> None:
    """Raise an error for a kinetic coefficient that exceeds the static one."""
    for name, pair in table.items():
        if pair.kinetic is not None and pair.kinetic > pair.static:
            message = f"{pair.kinetic:g} exceeds the static coefficient; give at most {pair.static:g}"
            raise inconsistent(("materials", name, "kinetic"), message)


def look_up(contacts: list[Contact], table: Mapping[str, MaterialPair]) -> None:
    """Replace the materials of contacts by their coefficients: those of ``table``, otherwise typical ones."""
    for index, contact in enumerate(contacts):
        friction = contact.friction
        if friction is None or friction.materials is None:
            continue
        a, b = friction.materials
        own = table.get(f"{a}-{b}") or table.get(f"{b}-{a}")
        try:
            found = own or _core.Friction.of(a, b)
        except InputError as error:
            given = (
                f"; pairs in 'materials': {', '.join(table)}"
                if table
                else "; 'materials' can define other pairs"
            )
            raise inconsistent(("contacts", index, "friction", "materials"), f"{error}{given}") from None
        friction.static, friction.kinetic, friction.materials = found.static, found.kinetic, None
