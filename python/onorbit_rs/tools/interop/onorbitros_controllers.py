"""Selects the controllers of an OnOrbitROS namespace that are converted."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from onorbit_rs.common.suggestions import did_you_mean
from onorbit_rs.robots.wording import option
from onorbit_rs.tools.interop.onorbitros_controller import is_of_task, joints_of, read_task_law
from onorbit_rs.tools.interop.onorbitros_external import forwards_efforts, read_driven, read_efforts
from onorbit_rs.tools.interop.onorbitros_pid import is_pid, read_pid

if TYPE_CHECKING:
    from onorbit_rs.tools.interop.source import Source


def read_controllers(source: Source, wanted: str | None, external: bool) -> None:
    """Convert the controller ``wanted``; if None, all controllers, or the first if they cannot run together.

    A single controller of an end effector becomes ``tool``, ``controller`` and ``reference``; other or
    several controllers become ``controllers``. With ``external``, controllers with a PID follow commands.
    """
    if is_of_task(source.data):
        read_task_law(source, ("controller",))
        return
    parts = {name: part for name, part in source.data.items() if isinstance(part, dict)}
    known = [
        name for name, part in parts.items() if is_of_task(part) or is_pid(part) or forwards_efforts(part)
    ]
    if not known:
        kinds = ", ".join(sorted({str(part["type"]) for part in parts.values() if "type" in part})) or "none"
        raise source.fail(
            next(iter(source.data)),
            f"this mapping contains no controller that can be converted (types found: {kinds}); give one "
            "with an end_effector_link, or one of ROS Control that commands efforts, directly or with a PID",
        )  # fmt: skip
    if wanted is not None and wanted not in known:
        raise source.fail(known[0], f"no controller is named {wanted!r}{did_you_mean(wanted, known)}")
    chosen, why = ([wanted], "another controller was chosen") if wanted else _together(parts, known)
    for name in source.data:
        if name in chosen:
            source.note(name, "understood", "a controller" if len(chosen) > 1 else "the controller")
        else:
            source.note(name, "no meaning", why if name in known else "it computes no efforts from errors")
    if len(chosen) == 1 and is_of_task(parts[chosen[0]]):
        read_task_law(source.inside(chosen[0]), ("controller",))
        return
    _read_several(source, chosen, external)


def _together(parts: dict[str, Any], names: list[str]) -> tuple[list[str], str]:
    """Return all names; if they cannot run together, return the first name and the reason."""
    driven: set[str] = set()
    for name in names:
        joints = joints_of(parts[name])
        if len(names) > 1 and (not joints or driven & set(joints)):
            what = "drives joints of another controller" if joints else "lists no joints"
            choice = option("--controller", "controller=")
            return names[:1], f"{name} {what}, so they cannot run at the same time; choose one with {choice}"
        driven |= set(joints)
    return names, ""


def _read_several(source: Source, names: list[str], external: bool) -> None:
    """Convert the named controllers to entries of the key ``controllers``.

    The longest trajectory determines the duration of the run.
    """
    entries: list[dict[str, Any]] = []
    for name in names:
        inside = source.inside(name, apart=True)
        inside.result["name"] = name
        if is_of_task(inside.data):
            read_task_law(inside, ())
        elif forwards_efforts(inside.data):
            read_efforts(inside)
        elif external:
            read_driven(inside)
        else:
            read_pid(inside)
        run = inside.result.pop("simulation", None)
        if run is not None:
            settings = source.result.setdefault("simulation", {})
            settings["duration"] = max(run["duration"], settings.get("duration", 0.0))
        for at, text in inside.comments.items():
            if at[0] != "simulation":  # each key of an entry is on one line
                source.comments.setdefault(("controllers", len(entries), at[0]), text)
        entries.append(inside.result)
    source.result["controllers"] = entries
