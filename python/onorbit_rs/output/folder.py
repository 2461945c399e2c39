"""The output folder: claimed before the run, written by one process at a time, replaced file by file."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType

from onorbit_rs.exceptions import OutputFolderError, OutputInUseError, OutputNotWritableError
from onorbit_rs.files import (
    described,
    exists,
    is_real_folder,
    is_regular,
    remove,
    renamed,
    sync_folder,
)
from onorbit_rs.output.lock import LOCK, FolderLock, owner_of
from onorbit_rs.output.manifest import (
    CHECKPOINT,
    FIGURES,
    MANIFEST,
    RESULTS,
    SCENARIO,
    Entry,
    Manifest,
    read_manifest,
)
from onorbit_rs.output.refusals import edited, foreign, not_empty, not_writable
from onorbit_rs.output.replacement import Replacement


class OutputFolder:
    """Where the files of one run go; a context that keeps other processes from writing there."""

    def __init__(self, path: Path) -> None:
        """Lock a folder that is there."""
        self.path = path
        self._unfinished: set[str] = set()
        """Names of temporary files that a process which was killed left behind."""
        try:
            self._lock = FolderLock(path)
        except OutputInUseError:
            raise
        except OSError as error:
            raise not_writable(path, error) from error
        try:
            self._remove_temporaries()
            self.manifest = read_manifest(path)
        except BaseException:
            self._lock.release()
            raise

    @classmethod
    def claim(cls, path: str | os.PathLike[str], *, force: bool = False) -> OutputFolder:
        """Make the folder where missing, lock it, and see that it is empty and writable.

        Parameters
        ----------
        path : str or path
        force : bool
            Replace the files that ``manifest.json`` lists; all others stay.

        Raises
        ------
        OutputNotEmptyError
            It holds files and ``force`` is not set, or files of others where a run writes its own.
        OutputNotWritableError
            It is a file, or cannot be made or written.
        OutputInUseError
            Another process writes it.
        """
        folder = Path(path)
        _make(folder)
        if not force and not _is_empty(folder):
            if owner_of(folder) is not None:
                cls(folder).close()  # raises, with the name of its owner
            raise not_empty(folder)
        claimed = cls(folder)
        try:
            if not force and not _is_empty(folder):
                raise not_empty(folder)
            claimed._remove_earlier_run()
        except BaseException:
            claimed.close()
            raise
        return claimed

    def __enter__(self) -> OutputFolder:
        """Itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Let other processes write the folder."""
        self.close()

    def close(self) -> None:
        """Let other processes write the folder; what is written is on the disk."""
        self._lock.release()

    @contextmanager
    def replacing(self) -> Iterator[Replacement]:
        """Files that are replaced together at the end, or not at all where an error comes before it.

        The manifest is written first: a reader finds either the files that it lists or none that fit.
        """
        files = Replacement(self)
        try:
            yield files
            files.commit()
        finally:
            files.discard()

    @contextmanager
    def writing(self, name: str) -> Iterator[Path]:
        """A temporary path that becomes ``name`` when all went well.

        Raises
        ------
        OutputFolderError
            The disk is full or gone, or ``name`` is there and no run wrote it.
        """
        with self.replacing() as files, files.writing(name) as path:
            yield path

    def _check_lock(self) -> None:
        """Before anything is written: lock the folder again where the file of the lock was removed.

        Raises
        ------
        OutputInUseError
            Another process writes the folder now, or did meanwhile.
        """
        if self._lock.is_held:
            return
        self._lock.retake()
        found = read_manifest(self.path)
        if found not in (None, self.manifest or Manifest()):
            self._lock.release()
            raise OutputInUseError(
                f"{self.path} holds files of another run now: {LOCK} was removed while this process wrote "
                "there, and another one did too; run it again into another folder",
                path=str(self.path),
            )
        warnings.warn(
            f"{self._lock.path} was removed while this process writes the folder, and was made anew: leave "
            "it there, it keeps other commands from writing",
            UserWarning, stacklevel=2,
        )  # fmt: skip

    def check_replaceable(self, name: str) -> None:
        """Raise :class:`OutputNotEmptyError` where ``name`` is a link, or a file that no run wrote.

        So is a figure that was edited since: it may have taken hours, where numbers come again.
        """
        file = self.path / name
        parent = file.parent
        if exists(parent) and not is_real_folder(parent) and parent != self.path:
            raise OutputFolderError(f"cannot write {file}: {parent} is not a folder itself", path=str(file))
        listed = {} if self.manifest is None else self.manifest.files
        if exists(file) and not (name in listed and is_regular(file)):
            raise foreign(file)
        if name.startswith(FIGURES) and exists(file) and self._is_edited(name, listed[name]):
            raise edited(file)

    def check_figures(self) -> None:
        """Raise :class:`OutputNotEmptyError` where a figure was edited since a run or report wrote it."""
        for name in [] if self.manifest is None else self.manifest.files:
            if name.startswith(FIGURES):
                self.check_replaceable(name)

    def _is_edited(self, name: str, entry: Entry) -> bool:
        """Whether a file is another than the manifest says; a kill may have left an old one in its place."""
        return _as_partial(name) not in self._unfinished and Entry.of(self.path / name) != entry

    def expect_checkpoint(self, names: tuple[str, ...]) -> None:
        """Say in the manifest which files the checkpoint will have, before they are there."""
        self._check_lock()
        manifest = self.manifest or Manifest()
        folder = self.path / CHECKPOINT
        if not exists(folder):
            folder.mkdir()
        elif not is_real_folder(folder):
            raise OSError(f"{folder} is not a folder itself")
        if not set(names) <= set(manifest.checkpoint):
            self.write_manifest(Manifest(manifest.files, names))
            sync_folder(self.path)

    def write_manifest(self, manifest: Manifest) -> None:
        """Replace ``manifest.json``."""
        self.replace(MANIFEST, manifest.as_bytes())
        self.manifest = manifest

    def replace(self, name: str, content: bytes) -> None:
        """Replace one file as a whole, whoever wrote it."""
        temporary = self.temporary(name)
        with renamed(temporary, self.path / name):
            temporary.write_bytes(content)

    def temporary(self, name: str) -> Path:
        """Path of a new file beside the others, for what becomes ``name``.

        After a kill the next owner removes it.

        Raises
        ------
        OutputInUseError
            Another process has taken the folder: someone removed the lock of this one.
        """
        self._check_lock()
        return self.path / f".partial-{self._lock.token}-{_as_partial(name)}"

    def discard(self) -> None:
        """Remove what a run that never began has written."""
        self._check_lock()
        for name in (SCENARIO, MANIFEST):
            remove(self.path / name)

    def discard_checkpoint(self) -> None:
        """Remove the checkpoint of a run that ended; one that cannot be removed does no harm."""
        with suppress(OSError):
            self._check_lock()
            self._remove_checkpoint()

    def _remove_checkpoint(self) -> None:
        """The files that the manifest names, and the folder if it is empty then."""
        folder = self.path / CHECKPOINT
        if self.manifest is None or not is_real_folder(folder):
            return
        for name in self.manifest.checkpoint:  # the state first: rows alone count nothing
            remove(folder / name)
        if not any(folder.iterdir()):
            folder.rmdir()

    def _remove_temporaries(self) -> None:
        """Those of the process that was killed while it held the lock."""
        previous = self._lock.previous
        if previous is None or not previous.token.isalnum():
            return
        prefix = f".partial-{previous.token}-"
        for file in self.path.glob(f"{prefix}*"):
            self._unfinished.add(file.name.removeprefix(prefix))
            remove(file)

    def _remove_earlier_run(self) -> None:
        """Only what the manifest lists, after a look at all that a run will write."""
        for name in RESULTS:
            self.check_replaceable(name)
        for name in (FIGURES, CHECKPOINT):
            folder = self.path / name
            if exists(folder) and not is_real_folder(folder):
                raise foreign(folder)
        self.check_figures()
        manifest = self.manifest or Manifest()
        checkpoint = self.path / CHECKPOINT
        for file in checkpoint.iterdir() if exists(checkpoint) else ():
            if file.name not in manifest.checkpoint:
                raise foreign(file)
        try:
            self._remove_checkpoint()
            for name in sorted(manifest.files, key=_removal_order):
                remove(self.path / name)
            remove(self.path / MANIFEST)
        except OSError as error:
            raise not_writable(self.path, error) from error
        self.manifest = Manifest()


def _make(folder: Path) -> None:
    try:
        if folder.exists() and not folder.is_dir():
            raise OutputNotWritableError(
                f"output path is {described(folder)}, not a folder: {folder}", path=str(folder)
            )
        folder.mkdir(parents=True, exist_ok=True)
        next(folder.iterdir(), None)
    except OSError as error:
        if isinstance(error, OutputFolderError):
            raise
        raise not_writable(folder, error) from error


def _is_empty(folder: Path) -> bool:
    """But for the lock of a process that was killed, and what it had begun to write."""
    return not any(file.name != LOCK and not file.name.startswith(".partial-") for file in folder.iterdir())


def _as_partial(name: str) -> str:
    """The end of the name of the temporary file of what becomes ``name``."""
    return name.replace("/", "-")


def _removal_order(name: str) -> int:
    return RESULTS.index(name) if name in RESULTS else len(RESULTS)
