"""Makes untrusted text safe to print: control characters are escaped."""

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
"""ASCII replacements of the non-ASCII characters in messages of this package."""


def printable(text: object) -> str:
    r"""Return text as one line, with control characters and changes of writing direction escaped.

    >>> printable("arm\n\u202e\x1b[31m")
    'arm\\n\\u202e\\x1b[31m'
    """
    return "".join(char if char.isprintable() else _escaped(char) for char in str(text))


def shell_word(text: str | os.PathLike[str]) -> str:
    r"""Return a word for a shell, quoted if necessary.

    >>> shell_word("my run"), shell_word("a\nb")
    ("'my run'", "$'a\\x0ab'")
    """
    word = os.fspath(text)
    if word.isprintable():
        return shlex.quote(word)
    escaped = "".join(_in_quotes(char) for char in word)
    return f"$'{escaped}'"


def json_text(data: object, *, indent: int | None = None) -> str:
    r"""Return JSON text with non-ASCII letters, and with control characters escaped; it is also valid YAML.

    >>> json_text({"µ": "\x9b"})
    '{"µ": "\\u009b"}'
    """
    text = json.dumps(data, indent=indent, ensure_ascii=False, allow_nan=False)
    return "".join(char if char.isprintable() or char == "\n" else json.dumps(char)[1:-1] for char in text)


def json_value(value: Any) -> Any:
    """Return a value that JSON can represent: None for a number that is not finite."""
    if isinstance(value, (bool, str, int)) or value is None:
        return value
    number = float(value)
    return number if math.isfinite(number) else None


def _escaped(char: str) -> str:
    return char.encode("unicode_escape").decode("ascii")


def _in_quotes(char: str) -> str:
    """Return a character as written inside ``$'…'`` in bash and zsh; escapes are bytes, as in file names."""
    if char in "\\'":
        return f"\\{char}"
    return char if char.isprintable() else "".join(f"\\x{byte:02x}" for byte in os.fsencode(char))


def _replaced(error: UnicodeError) -> tuple[str, int]:
    """Return an ASCII replacement of the characters that an encoding lacks, and the position after them."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end].translate(_IN_ASCII)
    return "".join(char if char.isascii() else _escaped(char) for char in lacking), error.end


LACKING = "onorbit_lacking"
"""Name under which ``_replaced`` is registered as an error handler, for ``errors=`` of a stream."""
codecs.register_error(LACKING, _replaced)
