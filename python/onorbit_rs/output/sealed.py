"""JSON records that carry a SHA-256 of their own content."""

from __future__ import annotations

import hashlib
import json
from typing import Any

_SEAL = "sha256"


def sealed(record: dict[str, Any]) -> bytes:
    """The record as JSON, with the digest of its content as its last entry."""
    return json.dumps(record | {_SEAL: _digest(record)}, allow_nan=False).encode()


def unsealed(text: bytes) -> dict[str, Any]:
    """The record in what :func:`sealed` made.

    Raises
    ------
    ValueError
        It is no JSON mapping, has no digest, or its content does not match its digest.
    """
    try:
        record = json.loads(text)
        if not isinstance(record, dict):
            raise ValueError("it holds no mapping")
        seal = record.pop(_SEAL, None)
        if seal is None:
            raise ValueError("it has no checksum")
        if seal != _digest(record):
            raise ValueError("its checksum does not match its content: it was changed or damaged")
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    return record


def _digest(record: dict[str, Any]) -> str:
    """Of the values, whatever the order of the keys and the spaces between."""
    text = json.dumps(record, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()
