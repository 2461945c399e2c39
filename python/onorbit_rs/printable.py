"""Text of others' on a terminal: as it is where that is harmless, escaped where it would steer the screen."""

from __future__ import annotations

import codecs
import json
import math
import os
import shlex
from typing import Any

_IN_ASCII = str.maketrans(
    {
        "²": "^2", "³": "^3", "°": " deg", "µ": "u", "·": ".", "−": "-", "≤": "<=", "≥": ">=", "±": "+-",
        "×": "x", "Δ": "d", "Σ": "sum ", "…": "...", "→": "->", "’": "'",
    }
)  # fmt: skip
"""What our own words hold beyond ASCII."""


def printable(text: object) -> str:
    r"""Text in one line, its control characters and those that turn the direction of writing escaped.

    >>> printable("arm\n\u202e\x1b[31m")
    'arm\\n\\u202e\\x1b[31m'
    """
    return "".join(char if char.isprintable() else _escaped(char) for char in str(text))


def shell_word(text: str | os.PathLike[str]) -> str:
    r"""A word as a shell reads it back, quoted where needed.

    >>> shell_word("my run"), shell_word("a\nb")
    ("'my run'", "$'a\\x0ab'")
    """
    word = os.fspath(text)
    if word.isprintable():
        return shlex.quote(word)
    escaped = "".join(_in_quotes(char) for char in word)
    return f"$'{escaped}'"


def json_text(data: object, *, indent: int | None = None) -> str:
    r"""JSON whose strings hold letters as they are, and escaped what would steer a terminal or break a YAML.

    >>> json_text({"µ": "\x9b"})
    '{"µ": "\\u009b"}'
    """
    said = json.dumps(data, indent=indent, ensure_ascii=False, allow_nan=False)
    return "".join(char if char.isprintable() or char == "\n" else json.dumps(char)[1:-1] for char in said)


def json_value(value: Any) -> Any:
    """Of a number what JSON can hold: None where it is not finite."""
    if isinstance(value, (bool, str, int)) or value is None:
        return value
    number = float(value)
    return number if math.isfinite(number) else None


def _escaped(char: str) -> str:
    return char.encode("unicode_escape").decode("ascii")


def _in_quotes(char: str) -> str:
    """For ``$'…'`` of bash and zsh: bytes, as a file's name is made of them."""
    if char in "\\'":
        return f"\\{char}"
    return char if char.isprintable() else "".join(f"\\x{byte:02x}" for byte in os.fsencode(char))


def _replaced(error: UnicodeError) -> tuple[str, int]:
    """What a stream's encoding lacks, in ASCII."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end].translate(_IN_ASCII)
    return "".join(char if char.isascii() else _escaped(char) for char in lacking), error.end


LACKING = "onorbit_lacking"
"""Name of the way to encode what an encoding lacks, as ``errors=`` of a stream."""
codecs.register_error(LACKING, _replaced)
