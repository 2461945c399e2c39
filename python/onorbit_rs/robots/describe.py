"""What a robot is made of: as plain data, and as text for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import Console
from rich.markup import escape as _escape
from rich.table import Table
from rich.tree import Tree

from onorbit_rs.printable import printable

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs._core import Joint, Model

_DEEPEST = 12
"""Levels that the drawn tree is indented; a longer chain goes on at this one."""


def describe(model: Model) -> dict[str, Any]:
    """Everything that ``onorbit info`` prints, as plain data; SI and radians, None where there is no limit.

    Masses and inertias are those of bodies: a link with all that is fixed to it. Centres of mass and
    principal moments are given in the axes of the body's link; the robot's own in the base's, joints at zero.
    """
    com, moments = _whole(model)
    return {
        "name": model.name, "nq": model.nq, "nv": model.nv,
        "mass_kg": model.mass, "com_m": com, "principal_moments_kg_m2": moments,
        "bodies": [
            {
                "name": body.name, "mass_kg": body.mass, "com_m": list(body.com),
                "inertia_kg_m2": body.inertia, "principal_moments_kg_m2": _moments(np.array(body.inertia)),
            }
            for body in model.bodies
        ],
        "joints": [
            {
                "name": joint.name, "kind": joint.kind, "parent": joint.parent, "child": joint.child,
                "axis": list(joint.axis), "pose": joint.pose, "lower": joint.lower, "upper": joint.upper,
                "velocity": joint.velocity, "effort": joint.effort, "damping": joint.damping,
                "friction": joint.friction, "rotor_inertia": joint.rotor_inertia,
            }
            for joint in model.joints
        ],
        "frames": [{"name": frame.name, "body": frame.body, "pose": frame.pose} for frame in model.frames],
        "warnings": model.warnings,
    }  # fmt: skip


def print_info(model: Model, console: Console | None = None) -> None:
    """The tree, then tables of bodies and joints, then what was odd."""
    console = console or Console(highlight=False)
    console.width = max(console.width, 72)  # a narrower terminal breaks the lines: no number is cut
    com, moments = _whole(model)
    counts = f"{_count(len(model.bodies), 'body', 'bodies')}, {_count(len(model.joints), 'joint', 'joints')}"
    console.print(
        f"[bold]{_text(model.name)}[/bold]: {counts}, {_count(len(model.frames), 'frame', 'frames')}"
    )
    console.print(f"mass {model.mass:.6g} kg, nq = {model.nq}, nv = {model.nv}")
    console.print(f"joints at zero: centre of mass {_row(com)} m from the base's origin,")
    console.print(f"principal moments about it {_row(moments)} kg m²")
    console.print()
    console.print(_tree(model))
    console.print("\n[bold]bodies[/bold]: a link with what is fixed to it; centre of mass in the link's axes")
    console.print(_bodies(model))
    if model.joints:
        console.print(
            "\n[bold]joints[/bold]: axis in the child's link; rad and N m, or m and N where it slides"
        )
        console.print(_joints(model))
        if any(joint.damping or joint.friction or joint.rotor_inertia for joint in model.joints):
            console.print("\n[bold]losses and rotors[/bold]: N m s/rad, N m, kg m² (N s/m, N, kg)")
            console.print(_losses(model))
    if model.warnings:
        console.print(f"\n[bold yellow]odd[/bold yellow] ({len(model.warnings)}):")
        for warning in model.warnings:
            console.print(f"  - {_text(warning)}")


def _text(name: str) -> str:
    """A name of the file's, in which neither rich nor the terminal must see anything but letters."""
    return _escape(printable(name))


def _tree(model: Model) -> Tree:
    """Bodies below the bodies they hang on; in brackets the frames that are fixed to them."""
    frames: dict[str, list[str]] = {}
    for frame in model.frames:
        if frame.name != frame.body:
            frames.setdefault(frame.body, []).append(frame.name)

    def label(body: str, how: str) -> str:
        fixed = f" [dim]\\[{_text(', '.join(frames[body]))}][/dim]" if body in frames else ""
        return f"{_text(body)}{how}{fixed}"

    base = model.bodies[0].name
    root = Tree(label(base, " (base, floats)"))
    place = {base: (root, 0)}
    for joint in model.joints:
        above, depth = place[joint.parent]
        on = f" on {_text(joint.parent)}" if depth >= _DEEPEST else ""
        branch = above.add(label(joint.child, f" by {_text(joint.name)}{on}"))
        place[joint.child] = (above, depth) if depth >= _DEEPEST else (branch, depth + 1)
    return root


def _bodies(model: Model) -> Table:
    table = _table("name", "mass, kg", "centre of mass, m", "principal moments, kg m²")
    for body in model.bodies:
        table.add_row(
            _text(body.name), f"{body.mass:.5g}", _row(body.com), _row(_moments(np.array(body.inertia)))
        )
    return table


def _joints(model: Model) -> Table:
    table = _table("name", "kind", "axis", "from", "to", "rate", "effort")
    for joint in model.joints:
        bounds = (joint.lower, joint.upper, joint.velocity, joint.effort)
        table.add_row(_text(joint.name), _kind(joint), _axis(joint.axis), *map(_bound, bounds))
    return table


def _losses(model: Model) -> Table:
    table = _table("name", "damping", "friction", "rotor inertia")
    for joint in model.joints:
        amounts = (joint.damping, joint.friction, joint.rotor_inertia)
        table.add_row(_text(joint.name), *(f"{amount:.5g}" for amount in amounts))
    return table


def _table(*columns: str) -> Table:
    table = Table(box=None, padding=(0, 1, 0, 0), header_style="dim")
    for index, column in enumerate(columns):
        table.add_column(column, justify="left", overflow="fold", no_wrap=index > 0)
    return table


def _kind(joint: Joint) -> str:
    return "turns" if joint.kind == "revolute" else "slides"


def _bound(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _axis(axis: list[float]) -> str:
    """``-z`` for a coordinate axis, else its components."""
    for index, name in enumerate("xyz"):
        if abs(abs(axis[index]) - 1.0) < 1e-12:
            return f"{'-' if axis[index] < 0 else ''}{name}"
    return _row(axis, digits=2)


def _row(values: list[float], digits: int = 3) -> str:
    return " ".join(f"{value + 0.0:.{digits}g}" for value in values)


def _count(number: int, one: str, many: str) -> str:
    return f"{number} {one if number == 1 else many}"


def _moments(inertia: NDArray[np.float64]) -> list[float]:
    """Ascending."""
    return [float(moment) for moment in np.linalg.eigvalsh(inertia)]


def _whole(model: Model) -> tuple[list[float], list[float]]:
    """Centre of mass in the base's axes, and principal moments about it, joints at zero.

    From the base's block of the mass matrix: `I_com = I_origin + m c× c×`.
    """
    q = model.neutral()
    x, y, z = com = np.asarray(model.center_of_mass(q))
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    about_com = np.asarray(model.mass_matrix(q))[3:6, 3:6] + model.mass * cross @ cross
    return [float(value) for value in com], _moments(about_com)
