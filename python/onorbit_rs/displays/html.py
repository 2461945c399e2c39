"""HTML of a model and of a run for notebooks; names and other texts of users are escaped."""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING, Any

from onorbit_rs.common.display_units import digits
from onorbit_rs.displays.cells import rows_html
from onorbit_rs.output.checks import checks, world_checks

if TYPE_CHECKING:
    from onorbit_rs._core import Joint, Model
    from onorbit_rs.simulation.run import Run

_NUMBERS = ("simulated_s", "rows", "wall_s", "base_rotation_max_rad", "base_displacement_max_m")
_MOST_EVENTS = 10
_MOST_LINKS = 200


def model_html(model: Model) -> str:
    """Return the tree of links with masses, kg, and of joints with type and limits, deg or m, as HTML."""
    masses = {body.name: body.mass for body in model.bodies}
    children: dict[str, list[Joint]] = {}
    for joint in model.joints:
        children.setdefault(joint.parent, []).append(joint)
    head = f"<b>{escape(model.name)}</b>: {digits(model.mass)} kg, joints: {len(model.joints)}"
    lines: list[str] = []
    todo: list[tuple[str, int, str]] = [(next(iter(masses)), 0, "")]
    while todo and len(lines) < _MOST_LINKS:  # a chain may be longer than Python's recursion limit
        name, depth, how = todo.pop()
        mass = f"{digits(masses[name])} kg" if name in masses else ""
        lines.append(
            f'<div style="padding-left:{min(depth, 40)}em">{how}<b>{escape(name)}</b> {escape(mass)}</div>'
        )
        todo += [(one.child, depth + 1, _joint(one)) for one in reversed(children.get(name, []))]
    rest = f"<div>… links not shown: {len(masses) - len(lines)}</div>" if todo else ""
    return f"<div>{head}{''.join(lines)}{rest}</div>"


def run_html(run: Run) -> str:
    """Return the checks of the certificate, a few numbers and the events of a run as an HTML table."""
    from onorbit_rs.report.numbers import row

    summary = run.summary
    found = world_checks(summary) if "systems" in summary else checks(summary)
    verdicts = {True: "passed", False: "failed", None: "not evaluated"}
    lines = [(check.name, _number(check.value), check.unit, verdicts[check.holds]) for check in found]
    rows = [row(key, summary[key]) for key in _NUMBERS if key in summary]
    lines += [(one.name, one.shown, one.unit, "") for one in rows]
    events = summary.get("events") or []
    lines += [(str(event.get("name", "")), _number(event.get("time_s")), "s", str(event.get("kind", "event")))
              for event in events[:_MOST_EVENTS]]  # fmt: skip
    if len(events) > _MOST_EVENTS:
        lines.append((f"events not shown: {len(events) - _MOST_EVENTS}", "", "", ""))
    return f"<div>{escape(repr(run))}{rows_html(lines)}</div>"


def trace_png(trace: Any) -> bytes:
    """Return a plot of the base's position and of the joint positions as PNG."""
    from onorbit_rs.figures.plot import plot

    shown: bytes = plot(trace)._repr_png_()  # type: ignore[attr-defined]
    return shown


def _number(value: Any) -> str:
    return digits(value) if isinstance(value, (int, float)) else ""


def _joint(joint: Joint) -> str:
    """Return the name, the type and the limits, deg or m, of a joint as HTML."""
    degrees = joint.kind == "revolute"
    limits = [value if value is not None and math.isfinite(value) else None
              for value in (joint.lower, joint.upper)]  # fmt: skip
    shown = ["…" if value is None else digits(math.degrees(value) if degrees else value) for value in limits]
    span = "" if limits == [None, None] else f", {shown[0]} to {shown[1]} {'deg' if degrees else 'm'}"
    return f"<small>{escape(joint.name)} ({joint.kind}{span}) → </small>"
