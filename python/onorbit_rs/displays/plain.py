"""Short ``repr`` for classes of the engine: the name of the class with its arguments or attributes."""

from __future__ import annotations

from typing import Any

_MOST = 60
"""Largest number of characters of one argument."""


def plain(shown: Any) -> str:
    """Return a call such as ``Circle(radius=0.2)``, or the class with its attributes, as ``<Trace: …>``.

    The second form is for objects whose pickle does not contain the arguments of their constructor.

    Long arguments are replaced by their shape or shortened.
    """
    name = type(shown).__name__
    try:
        arguments, keywords = arguments_of(shown)
    except Exception:  # objects that cannot be pickled, such as views of a running simulation
        return f"<{name}{_sizes(shown)}>"
    parts = [_short(value) for value in arguments]
    parts += [f"{key}={_short(value)}" for key, value in keywords.items() if value is not None]
    return f"{name}({', '.join(parts)})"


def arguments_of(shown: Any) -> tuple[tuple[Any, ...], dict[str, Any]]:
    """Return positional and keyword arguments of the constructor of an object, taken from its pickled form.

    Raises an error if the object cannot be pickled.
    """
    _, packed = shown.__reduce__()[:2]
    (_, arguments, keywords) = packed
    return tuple(arguments), dict(keywords or {})


def _short(value: Any) -> str:
    shape = getattr(value, "shape", None)
    if shape is not None and getattr(value, "size", 0) > 6:
        return f"array{tuple(shape)}"
    text = repr(value.tolist() if shape is not None and hasattr(value, "tolist") else value)
    text = " ".join(text.split())
    return text if len(text) <= _MOST else f"{text[: _MOST // 2]}…{text[-_MOST // 4 :]}"


def _sizes(shown: Any) -> str:
    """Return the attributes that are numbers, texts or arrays as text, such as ``: inertia (6, 6)``."""
    found = []
    for name in dir(type(shown)):
        try:
            value = None if name.startswith("_") else getattr(shown, name)
        except Exception:  # an attribute that does not apply is not shown
            continue
        shape = getattr(value, "shape", None)
        if shape or isinstance(value, (int, float, str)):
            found.append(f"{name} {tuple(shape) if shape else _short(value)}")
    return f": {', '.join(found)}" if found else ""
