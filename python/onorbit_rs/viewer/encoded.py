"""The content of a ``.rrd`` in memory: rerun's own file sink waits for ever where the disk is full."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import rerun as rr

from onorbit_rs.exceptions import OnOrbitError

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
        if hasattr(os, "memfd_create") and Path("/proc/self/fd").is_dir():
            self._memory = os.fdopen(os.memfd_create("run.rrd"), "rb")
            recording.save(f"/proc/self/fd/{self._memory.fileno()}")
        else:
            self._stream = rr.binary_stream(recording)

    def write_to(self, path: Path) -> None:
        """Write the file and end the recording."""
        try:
            if self._stream is not None:
                path.write_bytes(self._stream.read(flush_timeout_sec=FLUSH_TIMEOUT_S) or b"")
                self._recording.disconnect()
                return
            self._recording.flush(timeout_sec=FLUSH_TIMEOUT_S)
            self._recording.disconnect()
        except RuntimeError as error:
            raise OnOrbitError(f"rerun did not encode the recording: {error}") from error
        with self._memory as memory:
            memory.seek(-_FOOTER_BYTES, os.SEEK_END)
            if not memory.read().startswith(_MAGIC):  # its thread ran out of memory, and says so to nobody
                raise OnOrbitError("rerun did not encode the recording to its end")
            shutil.copyfile(f"/proc/self/fd/{memory.fileno()}", path)  # within the kernel
