"""The content of a ``.rrd`` in memory: rerun's own file sink waits for ever where the disk is full."""

from __future__ import annotations

import os
import shutil
from contextlib import nullcontext
from pathlib import Path
from typing import BinaryIO

import rerun as rr

from onorbit_rs.exceptions import ViewerError

FLUSH_TIMEOUT_S = 300.0
"""Wall-clock time given to rerun's encoder, which needs seconds."""

_MAGIC, _FOOTER_BYTES = b"RRF2", 12
"""What a complete file ends with."""


class Encoded:
    """Takes all that a recording is sent from now on.

    Where there are files in memory (Linux) rerun compresses in a thread of its own while rows still come.
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        """Before anything is sent."""
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
            It was not encoded to its end.
        """
        with self._memory or nullcontext() as memory:
            content = self._end()
            if memory is None:
                path.write_bytes(content)
                return
            memory.seek(-_FOOTER_BYTES, os.SEEK_END)
            if not memory.read().startswith(_MAGIC):  # its thread ran out of memory, and says so to nobody
                raise _not_encoded("it stops before its end")
            shutil.copyfile(f"/proc/self/fd/{memory.fileno()}", path)  # within the kernel

    def _end(self) -> bytes:
        """End the recording; its content, where that is in no file."""
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
    return ViewerError(f"rerun did not encode the recording: {why}", reason=why)
