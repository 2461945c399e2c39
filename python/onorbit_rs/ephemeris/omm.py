"""Reads CCSDS Orbit Mean-Elements Messages in JSON and KVN and, with PyPI's ``sgp4``, in XML and CSV."""

from __future__ import annotations

import csv
import io
import json
import textwrap
from collections.abc import Mapping
from typing import Any
from xml.etree.ElementTree import ParseError

from onorbit_rs.ephemeris.element_sets import select_set
from onorbit_rs.exceptions import ElementSetError


def entries(text: str, satellite: str | None = None, *, where: str = "the OMM") -> dict[str, Any]:
    """Return the keywords and values of the only OMM in a text, or of that of ``satellite`` (name or number).

    ``where`` is the name of the source in error messages.

    Raises
    ------
    ElementSetError
        If the text is not an OMM or does not contain exactly one such message.
    """
    messages = _messages(text.lstrip("\ufeff \t\r\n"), where)
    if satellite is not None:
        named = (
            (str(message.get("OBJECT_NAME", "")), str(message.get("NORAD_CAT_ID", "")), message)
            for message in messages
        )
        return select_set(named, satellite, where)
    if len(messages) != 1:
        if not messages:
            raise ElementSetError(f"{where} contains no message; give one Orbit Mean-Elements Message (OMM)")
        raise ElementSetError(
            f"{where} contains {len(messages)} messages; give a single message, or select one in a scenario "
            "with 'satellite', its name or catalogue number"
        )
    return messages[0]


def _messages(text: str, where: str) -> list[dict[str, Any]]:
    start, first_line = text[:1], text.partition("\n")[0]
    if start in ("{", "["):
        return _from_json(text, where)
    if start == "<":
        return _from_xml(text, where)
    if "," in first_line and "=" not in first_line:
        return _from_csv(text, where)
    return [_from_kvn(text, where)]


def _from_json(text: str, where: str) -> list[dict[str, Any]]:
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        reason = "nested too deeply" if isinstance(error, RecursionError) else error
        raise ElementSetError(f"{where} is not valid JSON: {reason}; correct the file") from None
    messages = data if isinstance(data, list) else [data]
    for number, message in enumerate(messages, start=1):
        if not isinstance(message, Mapping):
            raise ElementSetError(
                f"message {number} in {where} is {textwrap.shorten(repr(message), 40)}; a message in JSON "
                'must be a mapping of keywords to values, such as {"OBJECT_NAME": "ISS", ...}'
            )
    return messages


def _from_xml(text: str, where: str) -> list[dict[str, Any]]:
    from sgp4 import omm

    if "<!DOCTYPE" in text:  # its entities can expand to any length
        raise ElementSetError(
            f"{where} contains a document type declaration (<!DOCTYPE ...>), which is not accepted, "
            "because its entities can expand to any length; remove the declaration"
        )
    try:
        messages = list(omm.parse_xml(io.StringIO(text)))
    except (ParseError, LookupError, ValueError) as error:  # LookupError: unknown encoding
        raise ElementSetError(f"{where} is not valid XML: {error}; correct the file") from None
    except (AttributeError, TypeError):  # sgp4 got None for a missing element
        raise ElementSetError(
            f"a segment in {where} has no metadata, meanElements or tleParameters; every segment of an OMM "
            "in XML must contain all three elements"
        ) from None
    return [{key: value or "" for key, value in message.items()} for message in messages]


def _from_csv(text: str, where: str) -> list[dict[str, Any]]:
    from sgp4 import omm

    try:
        return [
            {key: value for key, value in row.items() if key is not None and value is not None}
            for row in omm.parse_csv(io.StringIO(text, newline=""))
        ]
    except csv.Error as error:
        raise ElementSetError(f"{where} is not valid CSV: {error}; correct the file") from None


def _from_kvn(text: str, where: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for line in text.splitlines():
        key, equals, value = line.partition("=")
        if not equals or key.strip() == "COMMENT" or key.startswith("COMMENT "):
            continue
        if key.strip() in found:
            raise ElementSetError(
                f"{where} contains {key.strip()} more than once; give a single message, with each keyword "
                "once",
                name=key.strip(),
            )
        found[key.strip()] = value.split("[")[0].strip()
    if not found:
        raise ElementSetError(
            f"{where} is not an Orbit Mean-Elements Message (OMM): it is neither JSON, XML nor CSV, and has "
            "no line KEYWORD = value; give an OMM in one of these four formats"
        )
    return found
