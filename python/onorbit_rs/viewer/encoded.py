"""Encodes a ``.rrd`` in memory, because rerun's file sink never returns when the disk is full."""

from __future__ import annotations

import os
import shutil
from contextlib import nullcontext
from pathlib import Path
from typing import BinaryIO

import rerun as rr

from onorbit_rs.exceptions import ViewerError

FLUSH_TIMEOUT_S = 300.0
"""Timeout of rerun's encoder, s; encoding usually takes a few seconds."""

_MAGIC, _FOOTER_BYTES = b"RRF2", 12
"""First bytes of the footer that ends a complete file, and size of the footer, bytes."""


class Encoded:
    """Encodes all data that are sent to a recording after construction.

    On Linux, rerun writes to a file in memory and compresses in its own thread while rows are sent.
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        """Attach to a recording before anything is sent."""
        self._recording = recording
        self._stream: rr.BinaryStream | None = None
        self._memory: BinaryIO | None = None
        if hasattr(os, "memfd_create") and Path("/proc/self/fd").is_dir():
            self._memory = os.fdopen(os.memfd_create("run.rrd"), "rb")
            recording.save(f"/proc/self/fd/{self._memory.fileno()}")
        else:
            self._stream = rr.binary_stream(recording)

    def write_to(self, path: Path) -> None:
        """Write the file and end the recording.

        Raises
        ------
        ViewerError
            If the recording was not encoded completely.
        """
        with self._memory or nullcontext() as memory:
            content = self._end()
            if memory is None:
                path.write_bytes(content)
                return
            memory.seek(-_FOOTER_BYTES, os.SEEK_END)
            if not memory.read().startswith(
                _MAGIC
            ):  # rerun's thread ran out of memory without raising an error
                raise _not_encoded("it is truncated")
            shutil.copyfile(f"/proc/self/fd/{memory.fileno()}", path)  # copied by the kernel

    def _end(self) -> bytes:
        """End the recording; return its content unless it was written to a file."""
        content = b""
        try:
            if self._stream is not None:
                content = self._stream.read(flush_timeout_sec=FLUSH_TIMEOUT_S) or b""
            else:
                self._recording.flush(timeout_sec=FLUSH_TIMEOUT_S)
            self._recording.disconnect()
        except RuntimeError as error:
            raise _not_encoded(str(error)) from error
        return content


def _not_encoded(why: str) -> ViewerError:
    return ViewerError(
        f"rerun did not encode the recording: {why}; free memory or record fewer rows with record_every",
        reason=why,
    )
