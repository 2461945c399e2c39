"""Reads CCSDS Orbit Mean-Elements Messages: JSON and KVN, and XML and CSV with PyPI's ``sgp4``."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping
from typing import Any
from xml.etree.ElementTree import ParseError

from onorbit_rs.common.counting import count
from onorbit_rs.ephemeris.element_sets import select_set
from onorbit_rs.exceptions import ElementSetError


def entries(text: str, satellite: str | None = None) -> dict[str, Any]:
    """Return the keywords and values of the only message, or of the one for ``satellite`` (name or number).

    Raises
    ------
    ElementSetError
        If the text is not an OMM or does not contain exactly one such message.
    """
    messages = _messages(text.lstrip("\ufeff \t\r\n"))
    if satellite is not None:
        named = (
            (str(message.get("OBJECT_NAME", "")), str(message.get("NORAD_CAT_ID", "")), message)
            for message in messages
        )
        return select_set(named, satellite, "the OMM")
    if len(messages) != 1:
        found = count(len(messages), "message", "messages")
        if not messages:
            raise ElementSetError("the text contains no OMM; give a single message")
        raise ElementSetError(
            f"the text contains {found}; give a single message, or select one in a scenario with 'satellite'"
        )
    return messages[0]


def _messages(text: str) -> list[dict[str, Any]]:
    start, first_line = text[:1], text.partition("\n")[0]
    if start in ("{", "["):
        return _from_json(text)
    if start == "<":
        return _from_xml(text)
    return _from_csv(text) if "," in first_line and "=" not in first_line else [_from_kvn(text)]


def _from_json(text: str) -> list[dict[str, Any]]:
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        reason = "nested too deeply" if isinstance(error, RecursionError) else error
        raise ElementSetError(f"the OMM is not valid JSON: {reason}") from None
    messages = data if isinstance(data, list) else [data]
    if not all(isinstance(message, Mapping) for message in messages):
        raise ElementSetError(
            "the OMM in JSON must be a mapping of keywords to values, or a list of such mappings"
        )
    return messages


def _from_xml(text: str) -> list[dict[str, Any]]:
    from sgp4 import omm

    if "<!DOCTYPE" in text:  # its entities can expand to any length
        raise ElementSetError(
            "the OMM has a document type (<!DOCTYPE>), which is not allowed; remove that tag"
        )
    try:
        messages = list(omm.parse_xml(io.StringIO(text)))
    except (ParseError, LookupError, ValueError) as error:  # LookupError: unknown encoding
        raise ElementSetError(f"the OMM cannot be read as XML: {error}") from None
    except (AttributeError, TypeError):  # sgp4 got None for a missing element
        raise ElementSetError(
            "the OMM's XML lacks metadata, meanElements or tleParameters in a segment"
        ) from None
    return [{key: value or "" for key, value in message.items()} for message in messages]


def _from_csv(text: str) -> list[dict[str, Any]]:
    from sgp4 import omm

    try:
        return [
            {key: value for key, value in row.items() if key is not None and value is not None}
            for row in omm.parse_csv(io.StringIO(text, newline=""))
        ]
    except csv.Error as error:
        raise ElementSetError(f"the OMM is not valid CSV: {error}") from None


def _from_kvn(text: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for line in text.splitlines():
        key, equals, value = line.partition("=")
        if not equals or key.strip() == "COMMENT" or key.startswith("COMMENT "):
            continue
        if key.strip() in found:
            raise ElementSetError(
                f"the OMM contains {key.strip()} more than once; give a single message, with each "
                "keyword once",
                name=key.strip(),
            )
        found[key.strip()] = value.split("[")[0].strip()
    if not found:
        raise ElementSetError(
            "the text is not an OMM: it is neither JSON, XML nor CSV, and has no line KEY = value"
        )
    return found
