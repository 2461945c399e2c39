"""The text of a CCSDS Orbit Mean-Elements Message: JSON, XML or KVN (``KEY = value`` lines)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any
from xml.etree import ElementTree

from onorbit_rs.exceptions import ElementSetError


def entries(text: str) -> dict[str, Any]:
    """Keywords and values of one message.

    Raises
    ------
    ElementSetError
        No such text, or not exactly one message in it.
    """
    start = text.lstrip("\ufeff \t\r\n")[:1]
    if start in ("{", "["):
        return _from_json(text)
    return _from_xml(text.lstrip("\ufeff \t\r\n")) if start == "<" else _from_kvn(text)


def _from_json(text: str) -> dict[str, Any]:
    try:
        data = json.loads(text.lstrip("\ufeff"))
    except (ValueError, RecursionError) as error:
        reason = "nested too deep" if isinstance(error, RecursionError) else error
        raise ElementSetError(f"the OMM is no JSON: {reason}") from None
    messages = data if isinstance(data, list) else [data]
    message = _the_one(messages)
    if not isinstance(message, Mapping):
        raise ElementSetError("the OMM's JSON is no mapping of keywords to values")
    return dict(message)


def _from_xml(text: str) -> dict[str, Any]:
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise ElementSetError(f"the OMM is no XML: {error}") from None
    segment = _the_one(root.findall(".//segment"))
    return {leaf.tag: leaf.text or "" for leaf in segment.iter() if len(leaf) == 0}


def _from_kvn(text: str) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for line in text.splitlines():
        key, equals, value = line.partition("=")
        if not equals or key.strip() == "COMMENT" or key.startswith("COMMENT "):
            continue
        if key.strip() in found:
            raise ElementSetError(f"the OMM gives {key.strip()} twice: give one message", name=key.strip())
        found[key.strip()] = value.split("[")[0].strip()
    if not found:
        raise ElementSetError("the text is no OMM: it is neither JSON nor XML, and no line reads KEY = value")
    return found


def _the_one(messages: list[Any]) -> Any:
    if len(messages) != 1:
        raise ElementSetError(f"the text holds {len(messages)} messages: give one")
    return messages[0]
