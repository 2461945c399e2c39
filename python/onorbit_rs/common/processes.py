"""Sends objects between this process and processes that it has started, as pickles.

Reading a pickle can execute arbitrary code. These functions are therefore used only for pipes and connections
between processes of the same user, never for files.
"""

from __future__ import annotations

import pickle
from typing import IO, Any


def packed(message: object) -> bytes:
    """Return the pickle of an object."""
    return pickle.dumps(message, protocol=pickle.HIGHEST_PROTOCOL)


def unpacked(content: bytes) -> Any:
    """Return the object whose bytes :func:`packed` returned in another process of this package."""
    return pickle.loads(content)


def send(stream: IO[bytes], message: object) -> None:
    """Write an object to a pipe."""
    stream.write(packed(message))
    stream.flush()


def receive(stream: IO[bytes]) -> Any:
    """Return the next object from a pipe.

    Raises
    ------
    EOFError
        If the process at the other end closed the pipe or ended, even in the middle of an object.
    """
    try:
        return pickle.load(stream)
    except pickle.UnpicklingError as error:
        raise EOFError(str(error)) from error
