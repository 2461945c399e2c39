"""Encodes the state of a controller written in Python as text for a checkpoint, and decodes it.

Numbers, text, lists, tuples, mappings and numeric arrays are converted to JSON without loss. Decoding creates
only these types, whatever the text contains.
"""

from __future__ import annotations

import base64
import json
import math
import re
from contextlib import suppress
from typing import Any

import numpy as np

from onorbit_rs.exceptions import CheckpointError, ControlError

ALLOWED = "None, bool, int, float, complex, str, list, tuple, dict and numeric NumPy arrays"

_FORMAT = "onorbit_rs controller state 1"
_DTYPE = re.compile(r"[<>|][biufc][1-9][0-9]?")
_KEYS = (type(None), bool, int, float, str, tuple)


def encode(state: object) -> bytes:
    """Return a controller's state as JSON text in ASCII.

    Raises
    ------
    ControlError
        If the state is nested too deeply, or contains a value that is not plain data; the message names the
        location and the allowed types.
    """
    with suppress(
        RecursionError
    ):  # so that it is not the context of the error below, which programs may pickle
        data = {"format": _FORMAT, "state": _Encoder().encoded(state, "state")}
        return json.dumps(data, allow_nan=False).encode("ascii")
    raise ControlError(
        "state is nested too deeply for a checkpoint; return data with fewer levels from get_state()",
        name="state", got=_name(type(state)), expected=ALLOWED,
    )  # fmt: skip


def decode(text: bytes) -> Any:
    """Return the state from the text that :func:`encode` returned.

    Raises
    ------
    CheckpointError
        If the text was not written by :func:`encode`, such as a pickle of an earlier version, which is not
        loaded.
    """
    if text.startswith(b"\x80"):
        raise CheckpointError(
            "the checkpoint contains the state of a Python controller as a pickle, as in earlier versions "
            "of onorbit_rs; reading a pickle can execute any code, so this pickle is not read; run the "
            "scenario again"
        )
    try:
        data = json.loads(text)
        if data["format"] != _FORMAT:
            raise ValueError(f"its format is {data['format']!r}, expected {_FORMAT!r}")
        return _Decoder().decoded(data["state"])
    except (ValueError, KeyError, TypeError, IndexError, RecursionError, OverflowError) as error:
        reason = f"the key {error} is missing" if isinstance(error, KeyError) else error
        raise CheckpointError(
            f"the state of a Python controller in the checkpoint is invalid ({reason}); run the scenario "
            "again"
        ) from error


class _Encoder:
    """Encodes one state; a list, mapping or array that occurs again is replaced by its number."""

    def __init__(self) -> None:
        self._numbers: dict[int, int] = {}

    def encoded(self, value: object, place: str) -> Any:
        kind = type(value)
        if value is None or kind in (bool, int, str):
            return value
        if isinstance(value, float) and kind is float:
            return value if math.isfinite(value) else {"float": str(value)}
        if isinstance(value, complex) and kind is complex:
            return {"complex": [self.encoded(part, place) for part in (value.real, value.imag)]}
        if isinstance(value, tuple) and kind is tuple:
            return {"tuple": [self.encoded(item, f"{place}[{i}]") for i, item in enumerate(value)]}
        if isinstance(value, np.generic):
            return {"scalar": _array(np.asarray(value), place, value)}
        if kind not in (list, dict, np.ndarray):
            raise _refused(place, f"is of type {_name(kind)}", value)
        if id(value) in self._numbers:
            return {"again": self._numbers[id(value)]}
        self._numbers[id(value)] = len(self._numbers)
        if isinstance(value, list):
            return [self.encoded(item, f"{place}[{i}]") for i, item in enumerate(value)]
        if isinstance(value, dict):
            return {"dict": [self._item(key, item, place) for key, item in value.items()]}
        assert isinstance(value, np.ndarray)
        return {"array": _array(value, place, value)}

    def _item(self, key: object, value: object, place: str) -> list[Any]:
        if type(key) not in _KEYS:
            name, allowed = _name(type(key)), "None, bool, int, float, str or tuple"
            raise ControlError(
                f"a key of {place} is of type {name}; keys must be {allowed}; convert the key in get_state() "
                "and restore it in set_state()",
                name=f"a key of {place}", got=name, expected=allowed,
            )  # fmt: skip
        return [self.encoded(key, f"a key of {place}"), self.encoded(value, f"{place}[{key!r}]")]


class _Decoder:
    """Decodes one state; lists, mappings and arrays have the same numbers as in the encoder."""

    def __init__(self) -> None:
        self._made: list[Any] = []

    def decoded(self, data: Any) -> Any:
        if isinstance(data, list):
            made: list[Any] = []
            self._made.append(made)
            made.extend(self.decoded(item) for item in data)
            return made
        if not isinstance(data, dict):
            return data
        [(tag, held)] = data.items()
        if tag == "float":
            return float(held)
        if tag == "complex":
            return complex(*(self.decoded(part) for part in held))
        if tag == "tuple":
            return tuple(self.decoded(item) for item in held)
        if tag == "scalar":
            return _from_text(held)[()]
        if tag == "again":
            return self._made[held]
        if tag == "array":
            self._made.append(_from_text(held))
            return self._made[-1]
        if tag != "dict":
            raise ValueError(f"unknown kind of value {tag!r}")
        mapping: dict[Any, Any] = {}
        self._made.append(mapping)
        for key, item in held:
            mapping[self.decoded(key)] = self.decoded(item)
        return mapping


def _array(array: Any, place: str, value: object) -> dict[str, Any]:
    if not _DTYPE.fullmatch(array.dtype.str):
        raise _refused(place, f"is an array of dtype {array.dtype}", value)
    is_fortran = (
        array.flags.f_contiguous and not array.flags.c_contiguous
    )  # the memory order is preserved, since sums in another order could round differently
    data = array.tobytes(order="F" if is_fortran else "C")
    return {
        "dtype": array.dtype.str,
        "shape": list(array.shape),
        "order": "F" if is_fortran else "C",
        "data": base64.b64encode(data).decode("ascii"),
    }


def _from_text(held: Any) -> Any:
    if not _DTYPE.fullmatch(held["dtype"]):
        raise ValueError(f"unknown dtype {held['dtype']!r}")
    values = np.frombuffer(base64.b64decode(held["data"], validate=True), dtype=held["dtype"])
    shape = tuple(held["shape"])
    if any(type(length) is not int or length < 0 for length in shape):
        raise ValueError(f"invalid shape {shape}")
    return values.reshape(shape, order=held["order"]).copy(order=held["order"])


def _name(kind: type) -> str:
    return kind.__qualname__ if kind.__module__ == "builtins" else f"{kind.__module__}.{kind.__qualname__}"


def _refused(place: str, why: str, value: object) -> ControlError:
    hint = " (return the data itself, not a pickle of it)" if isinstance(value, bytes) else ""
    return ControlError(
        f"{place} {why}{hint}; a checkpoint can contain only {ALLOWED}; return such data from get_state() "
        "and restore it in set_state()",
        name=place, got=_name(type(value)), expected=ALLOWED,
    )  # fmt: skip
