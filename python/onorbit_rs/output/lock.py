"""Lock of an output folder: an operating-system lock, released when the process that holds it ends."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import secrets
import socket
import sys
import time
import warnings
from datetime import datetime
from pathlib import Path
from typing import Any, NamedTuple

from onorbit_rs.common.files import open_to_change, open_to_read, remove
from onorbit_rs.common.printable import printable, shell_word
from onorbit_rs.exceptions import OutputInUseError

LOCK = ".onorbit.lock"
_MOST = 10_000
_FAR = 1 << 30
"""Offset of the byte that is locked on Windows, beyond the text that other processes read."""
_UNSUPPORTED = {errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.ENOTSUP, errno.EINVAL}
_held: set[int] = set()
"""Descriptors of the locks of this process; a forked child closes them so as not to hold the locks."""


class Owner(NamedTuple):
    """The process that holds a lock, or was killed while holding it."""

    pid: int
    host: str
    command: str
    since: str
    token: str
    """Text that identifies the temporary files of the process by their names."""

    def __str__(self) -> str:
        """Return ``process 12 on host (onorbit run …) since 2026-01-01 12:00:00 +0000``.

        If the owner is unknown, return ``another process``.
        """
        if not self.pid:
            return "another process"
        return printable(f"process {self.pid} on {self.host} ({self.command}) since {self.since}")


_UNKNOWN = Owner(0, "an unknown host", "unknown command", "an unknown time", "")


class FolderLock:
    """Lock on a folder, held from construction to :meth:`release`."""

    def __init__(self, folder: Path) -> None:
        """Acquire the lock; raise :class:`OutputInUseError` if another process holds the lock."""
        self.path = folder / LOCK
        self._descriptor = self._taken(folder)
        _held.add(self._descriptor)
        self.previous = _owner(self.path)
        """The process that was killed while it held the lock, if any."""
        self.token = secrets.token_hex(8)
        self._sign()

    @property
    def is_held(self) -> bool:
        """True if the lock file that this process locked is still in the folder."""
        return _is_at(self.path, self._descriptor)

    def retake(self) -> None:
        """Lock the folder again after its file was removed.

        Raises
        ------
        OutputInUseError
            If another process acquired the lock in the meantime.
        """
        again = self._taken(self.path.parent)
        self._close()
        self._descriptor = again
        _held.add(again)
        self._sign()

    def release(self) -> None:
        """Release the lock; a second call has no effect."""
        with contextlib.suppress(OSError):  # Windows does not remove open files
            if self._descriptor in _held and self.is_held:
                remove(self.path)
        self._close()

    def _close(self) -> None:
        if self._descriptor in _held:
            _held.discard(self._descriptor)
            os.close(self._descriptor)
            self._descriptor = -1

    def _sign(self) -> None:
        """Write the description of this process to the lock file."""
        try:
            os.ftruncate(self._descriptor, 0)
            os.write(self._descriptor, json.dumps(_this_process(self.token)._asdict()).encode())
        except OSError:
            self.release()
            raise

    def _taken(self, folder: Path) -> int:
        """Return a locked descriptor of the current lock file, which its owner may remove at any time."""
        for attempt in range(20):
            with open_to_change(self.path) as stream:
                descriptor = os.dup(stream.fileno())
            os.set_inheritable(descriptor, False)
            try:
                if _try_lock(descriptor, folder) and _is_at(self.path, descriptor):
                    return descriptor
            except BaseException:
                os.close(descriptor)
                raise
            os.close(descriptor)
            time.sleep(0.01 if attempt else 0.0)  # processes that read the owner hold the lock for an instant
        raise _in_use(folder)


def owner_of(folder: Path) -> Owner | None:
    """Return the running process that holds the lock of a folder; None if there is none.

    Returns None, too, if the lock file cannot be opened. ``pid`` is 0 if the lock file does not identify the
    process.
    """
    try:
        with open_to_read(folder / LOCK) as stream:
            if _try_lock(stream.fileno(), None):
                return None
        return _owner(folder / LOCK) or _UNKNOWN
    except OSError:
        return None


def _in_use(folder: Path) -> OutputInUseError:
    owner = owner_of(folder) or _UNKNOWN
    message = f"{folder} is in use by {owner}; wait until it ends, or choose another folder"
    return OutputInUseError(
        message, path=str(folder), pid=owner.pid, command=owner.command, since=owner.since
    )


def _owner(file: Path) -> Owner | None:
    """Return the owner stored in a lock file; None if the file cannot be read."""
    try:
        with open_to_read(file) as stream:
            stored: Any = json.loads(stream.read(_MOST))
        owner = Owner(int(stored["pid"]), *(str(stored[name]) for name in Owner._fields[1:]))
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    return owner


def _this_process(token: str) -> Owner:
    program, *words = sys.argv or ["python"]
    words.insert(0, "onorbit" if Path(program).stem in ("onorbit", "__main__") else program)
    command = " ".join(map(shell_word, words))[:500]
    since = datetime.now().astimezone().strftime("%Y-%m-%d %H:%M:%S %z")
    return Owner(os.getpid(), socket.gethostname(), command, since, token)


def _is_at(file: Path, descriptor: int) -> bool:
    try:
        return os.path.samestat(file.lstat(), os.fstat(descriptor))
    except OSError:
        return False


def _try_lock(descriptor: int, folder: Path | None) -> bool:
    """Try to acquire the lock, in shared mode if ``folder`` is None; return False if it is not available.

    On a file system without locks, return True, with a warning if ``folder`` is given.
    """
    try:
        _lock(descriptor, is_shared=folder is None)
    except OSError as error:
        if error.errno not in _UNSUPPORTED:
            return False
        if folder is not None:
            warnings.warn(
                f"{folder} cannot be locked ({error.strerror}); make sure that no other command writes to it",
                UserWarning, stacklevel=2,
            )  # fmt: skip
    return True


if sys.platform == "win32":
    import msvcrt

    def _lock(descriptor: int, *, is_shared: bool) -> None:
        os.lseek(descriptor, _FAR, os.SEEK_SET)
        try:
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
            if is_shared:  # msvcrt has no shared locks
                os.lseek(descriptor, _FAR, os.SEEK_SET)
                msvcrt.locking(descriptor, msvcrt.LK_UNLCK, 1)
        finally:
            os.lseek(descriptor, 0, os.SEEK_SET)

else:
    import fcntl

    def _lock(descriptor: int, *, is_shared: bool) -> None:
        fcntl.flock(descriptor, (fcntl.LOCK_SH if is_shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)

    def _forget() -> None:
        for descriptor in _held:
            os.close(descriptor)
        _held.clear()

    os.register_at_fork(after_in_child=_forget)
