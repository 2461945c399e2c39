"""Text of others' on a terminal: as it is where that is harmless, escaped where it would steer the screen."""

from __future__ import annotations

import codecs
import os
import shlex

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
    ("'my run'", "$'a\\nb'")
    """
    word = os.fspath(text)
    if word.isprintable():
        return shlex.quote(word)
    escaped = "".join(_in_quotes(char) for char in word)
    return f"$'{escaped}'"


def _escaped(char: str) -> str:
    return char.encode("unicode_escape").decode("ascii")


def _in_quotes(char: str) -> str:
    """For ``$'…'`` of bash and zsh; a byte of a file's name that is no UTF-8 is that byte again."""
    if char in "\\'":
        return f"\\{char}"
    if char.isprintable():
        return char
    return f"\\x{ord(char) - 0xDC00:02x}" if "\udc80" <= char <= "\udcff" else _escaped(char)


def _replaced(error: UnicodeError) -> tuple[str, int]:
    """What a stream's encoding lacks, in ASCII."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end].translate(_IN_ASCII)
    return "".join(char if char.isascii() else _escaped(char) for char in lacking), error.end


LACKING = "onorbit_lacking"
"""Name of the way to encode what an encoding lacks, as ``errors=`` of a stream."""
codecs.register_error(LACKING, _replaced)
