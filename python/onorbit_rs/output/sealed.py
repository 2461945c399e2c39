"""JSON records that contain a SHA-256 of their content."""

from __future__ import annotations

import hashlib
import json
from typing import Any

_SEAL = "sha256"


def sealed(record: dict[str, Any]) -> bytes:
    """Return the record as JSON with the digest of its content as the last entry."""
    return json.dumps(record | {_SEAL: _digest(record)}, allow_nan=False).encode()


def unsealed(text: bytes) -> dict[str, Any]:
    """Return the record from the output of :func:`sealed`.

    Raises
    ------
    ValueError
        If the text is not a JSON mapping, has no digest, or does not match its digest.
    """
    try:
        record = json.loads(text)
        if not isinstance(record, dict):
            raise ValueError("its content is not a JSON mapping")
        seal = record.pop(_SEAL, None)
        if seal is None:
            raise ValueError("it has no checksum")
        if seal != _digest(record):
            raise ValueError("its checksum does not match its content, so it was changed or damaged")
    except RecursionError:
        raise ValueError("it is nested too deeply") from None
    return record


def _digest(record: dict[str, Any]) -> str:
    """Return the digest of the values, independent of the order of keys and of spaces."""
    text = json.dumps(record, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()
