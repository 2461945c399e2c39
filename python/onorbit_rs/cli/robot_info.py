"""Prints the description of a robot on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rich.table import Table
from rich.tree import Tree

from onorbit_rs.cli.console import text
from onorbit_rs.common.counting import count
from onorbit_rs.robots.describe import describe

if TYPE_CHECKING:
    from rich.console import Console

    from onorbit_rs._core import Model

_DEEPEST = 12
"""Largest indentation level of the tree; deeper bodies are printed at this level."""


def print_info(model: Model, console: Console) -> None:
    """Print the description of a robot: mass, tree, tables of bodies and joints, loops and warnings."""
    about = describe(model)
    counts = f"{count(len(model.bodies), 'body', 'bodies')}, {count(len(model.joints), 'joint', 'joints')}"
    console.print(f"[bold]{text(model.name)}[/bold]: {counts}, {count(len(model.frames), 'frame', 'frames')}")
    console.print(f"mass {model.mass:.6g} kg, nq = {model.nq}, nv = {model.nv}")
    console.print("with all joints at zero:")
    console.print(f"  centre of mass {_row(about['com_m'])} m from the base's origin,")
    console.print(f"  principal moments about it {_row(about['principal_moments_kg_m2'])} kg m²")
    console.print()
    console.print(_tree(model))
    console.print("\n[bold]bodies[/bold]: each link with the links fixed to it; centre of mass in link axes")
    console.print(_bodies(about))
    if model.joints:
        console.print(
            "\n[bold]joints[/bold]: axis in child link axes; rad and N m if revolute, m and N if prismatic"
        )
        console.print(_joints(model))
        if any(joint.damping or joint.static_friction or joint.rotor_inertia for joint in model.joints):
            console.print(
                "\n[bold]friction and rotors[/bold]: N m s/rad, N m, N m, kg m² (prismatic: N s/m, N, N, kg)"
            )
            console.print(_losses(model))
        if any(joint.stiffness or joint.cubic_stiffness for joint in model.joints):
            console.print("\n[bold]springs[/bold]: N m/rad, N m/rad³, rad (prismatic: N/m, N/m³, m)")
            console.print(_springs(model))
        for joint in model.joints:
            if joint.mimic is not None:
                console.print(text(_mimic(joint.name, *joint.mimic)))
    for loop in model.loops:
        console.print(text(f"loop {loop.name}: {loop.kind} between {loop.frame_a} and {loop.frame_b}"))
    if model.warnings:
        console.print(f"\n[bold yellow]warnings[/bold yellow] ({len(model.warnings)}):")
        for warning in model.warnings:
            console.print(f"  - {text(warning)}")


def _tree(model: Model) -> Tree:
    """Return the tree of bodies, with the frames fixed to each body in brackets."""
    frames: dict[str, list[str]] = {}
    for frame in model.frames:
        if frame.name != frame.body:
            frames.setdefault(frame.body, []).append(frame.name)

    def label(body: str, how: str) -> str:
        fixed = f" [dim]\\[{text(', '.join(frames[body]))}][/dim]" if body in frames else ""
        return f"{text(body)}{how}{fixed}"

    base = model.bodies[0].name
    root = Tree(label(base, " (base, free-floating)"))
    place = {base: (root, 0)}
    for joint in model.joints:
        above, depth = place[joint.parent]
        on = f" on {text(joint.parent)}" if depth >= _DEEPEST else ""
        branch = above.add(label(joint.child, f" by {text(joint.name)}{on}"))
        place[joint.child] = (above, depth) if depth >= _DEEPEST else (branch, depth + 1)
    return root


def _bodies(about: dict[str, Any]) -> Table:
    table = _table("name", "mass, kg", "centre of mass, m", "principal moments, kg m²")
    for body in about["bodies"]:
        moments = body["principal_moments_kg_m2"]
        table.add_row(text(body["name"]), f"{body['mass_kg']:.5g}", _row(body["com_m"]), _row(moments))
    return table


def _joints(model: Model) -> Table:
    table = _table("name", "kind", "axis", "from", "to", "rate", "effort")
    for joint in model.joints:
        bounds = (joint.lower, joint.upper, joint.velocity, joint.effort)
        table.add_row(text(joint.name), joint.kind, _axis(joint.axis), *map(_bound, bounds))
    return table


def _losses(model: Model) -> Table:
    table = _table("name", "damping", "friction", "at rest", "rotor inertia")
    for joint in model.joints:
        amounts = (joint.damping, joint.friction, joint.static_friction, joint.rotor_inertia)
        table.add_row(text(joint.name), *(f"{amount:.5g}" for amount in amounts))
    return table


def _springs(model: Model) -> Table:
    table = _table("name", "stiffness", "cubic stiffness", "rest position")
    for joint in model.joints:
        if joint.stiffness or joint.cubic_stiffness:
            amounts = (joint.stiffness, joint.cubic_stiffness, joint.rest_position)
            table.add_row(text(joint.name), *(f"{amount:.5g}" for amount in amounts))
    return table


def _mimic(joint: str, leader: str, ratio: float, offset: float) -> str:
    """Return the equation of a mimic joint, such as ``mimic joint: right = -1 left + 0.2``."""
    sign = "-" if offset < 0.0 else "+"
    return f"mimic joint: {joint} = {ratio:g} {leader}" + (f" {sign} {abs(offset):g}" if offset else "")


def _table(*columns: str) -> Table:
    table = Table(box=None, padding=(0, 1, 0, 0), header_style="dim")
    for index, column in enumerate(columns):
        table.add_column(column, justify="left", overflow="fold", no_wrap=index > 0)
    return table


def _bound(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _axis(axis: list[float]) -> str:
    """Return an axis as text: ``-z`` for a coordinate axis, otherwise its components."""
    for index, name in enumerate("xyz"):
        if abs(abs(axis[index]) - 1.0) < 1e-12:
            return f"{'-' if axis[index] < 0 else ''}{name}"
    return _row(axis, digits=2)


def _row(values: list[float], digits: int = 3) -> str:
    return " ".join(f"{value + 0.0:.{digits}g}" for value in values)
