"""The output folder of a run: only one process at a time can lock it, and files are replaced atomically."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType

from onorbit_rs.common.files import (
    exists,
    file_kind,
    is_real_folder,
    is_regular,
    remove,
    renamed,
    sync_folder,
)
from onorbit_rs.exceptions import OutputFolderError, OutputInUseError, OutputNotWritableError
from onorbit_rs.output.errors import edited, foreign, not_empty, not_writable
from onorbit_rs.output.lock import LOCK, FolderLock, owner_of
from onorbit_rs.output.manifest import (
    CHECKPOINT,
    COMMANDS,
    FIGURES,
    MANIFEST,
    RESULTS,
    SCENARIO,
    Entry,
    Manifest,
    read_manifest,
)
from onorbit_rs.output.replacement import Replacement


class OutputFolder:
    """Folder for the files of one run; a context manager that locks it against other processes."""

    def __init__(self, path: Path) -> None:
        """Lock an existing folder and read its manifest.

        Raises
        ------
        OutputInUseError, OutputNotWritableError, ReadError
            If another process has locked the folder, the folder is not writable, or its manifest is damaged.
        """
        self.path = path
        self._unfinished: set[str] = set()
        """Names of the temporary files of an earlier process that was killed."""
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
        """Create the folder if it does not exist, lock it, and check that it is empty and writable.

        Parameters
        ----------
        path : str or path
            Output folder.
        force : bool
            If True, remove the files that ``manifest.json`` lists; other files are kept.

        Raises
        ------
        OutputNotEmptyError
            If ``force`` is False and the folder contains files, or if it contains edited figures, or files
            with the names of results or in ``checkpoint`` that were not written by a run.
        OutputNotWritableError
            If the path is a file, or the folder cannot be created or written.
        OutputInUseError
            If another process is writing to the folder.
        ReadError
            If the manifest is damaged.
        """
        folder = Path(path)
        make_folder(folder)
        if not force and not _is_empty(folder):
            if owner_of(folder) is not None:
                cls(folder).close()  # raises an error that names the process
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
        """Return the folder."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Release the lock."""
        self.close()

    def close(self) -> None:
        """Release the lock; all written files are already on the disk."""
        self._lock.release()

    @contextmanager
    def replacing(self) -> Iterator[Replacement]:
        """Yield a group of files that are replaced together after the block.

        If the block fails, the old files remain.

        The manifest is written first, so that a reader detects files that were not replaced yet.
        """
        files = Replacement(self)
        try:
            yield files
            files.commit()
        finally:
            files.discard()

    @contextmanager
    def writing(self, name: str) -> Iterator[Path]:
        """Yield a temporary path, which is renamed to ``name`` on success.

        Raises
        ------
        OutputFolderError
            If the file cannot be written, is an edited figure, or exists but was not written by a run.
        """
        with self.replacing() as files, files.writing(name) as path:
            yield path

    def _check_lock(self) -> None:
        """Lock the folder again if its lock file was removed; called before each file is written.

        Raises
        ------
        OutputInUseError
            If another process writes to the folder, or wrote to it in the meantime.
        """
        if self._lock.is_held:
            return
        self._lock.retake()
        found = read_manifest(self.path)
        if found not in (None, self.manifest or Manifest()):
            self._lock.release()
            raise OutputInUseError(
                f"{self.path} now contains files of another run: {LOCK} was removed while this process wrote "
                "there, and another process wrote there too; repeat the run in another folder",
                path=str(self.path),
            )
        warnings.warn(
            f"{self._lock.path} was removed during the run and has been created again; keep it until the run "
            "ends, because it prevents other commands from writing to the folder",
            UserWarning, stacklevel=2,
        )  # fmt: skip

    def check_replaceable(self, name: str) -> None:
        """Raise an error if ``name`` may not be replaced.

        Edited figures are kept because, unlike results, they cannot be recomputed.

        Raises
        ------
        OutputNotEmptyError
            If the file was not written by a run, is not a regular file, or is an edited figure.
        OutputFolderError
            If the parent of the file is a link or not a folder.
        """
        file = self.path / name
        parent = file.parent
        if exists(parent) and not is_real_folder(parent) and parent != self.path:
            raise OutputFolderError(
                f"cannot write {file}: {parent} is {file_kind(parent)}, but must be a folder; remove it",
                path=str(file),
            )
        listed = {} if self.manifest is None else self.manifest.files
        if exists(file) and not (name in listed and is_regular(file)):
            raise foreign(file)
        if name.startswith(FIGURES) and exists(file) and self._is_edited(name, listed[name]):
            raise edited(file)

    def check_figures(self) -> None:
        """Raise :class:`OutputNotEmptyError` if a figure was edited since it was written."""
        for name in [] if self.manifest is None else self.manifest.files:
            if name.startswith(FIGURES):
                self.check_replaceable(name)

    def _is_edited(self, name: str, entry: Entry) -> bool:
        """Return True if a file differs from the manifest, unless a killed process was replacing it."""
        return _as_partial(name) not in self._unfinished and Entry.of(self.path / name) != entry

    def expect_checkpoint(self, names: tuple[str, ...]) -> None:
        """Create the folder of the checkpoint, and list its files in the manifest before they are created."""
        self._check_lock()
        manifest = self.manifest or Manifest()
        folder = self.path / CHECKPOINT
        if not exists(folder):
            folder.mkdir()
        elif not is_real_folder(folder):
            raise OSError(f"{folder} is {file_kind(folder)}, but must be a folder; remove it")
        if not set(names) <= set(manifest.checkpoint):
            self.write_manifest(Manifest(manifest.files, names))
            sync_folder(self.path)

    def write_manifest(self, manifest: Manifest) -> None:
        """Replace ``manifest.json``."""
        self.replace(MANIFEST, manifest.as_bytes())
        self.manifest = manifest

    def replace(self, name: str, content: bytes) -> None:
        """Replace one file atomically, whether or not a run wrote the old file."""
        temporary = self.temporary(name)
        with renamed(temporary, self.path / name):
            temporary.write_bytes(content)

    def temporary(self, name: str) -> Path:
        """Return the temporary path of a new file that will be renamed to ``name``.

        If this process is killed, the next process that locks the folder removes the temporary file.

        Raises
        ------
        OutputInUseError
            If another process locked the folder after the lock file was removed.
        """
        self._check_lock()
        return self.path / f".partial-{self._lock.token}-{_as_partial(name)}"

    def discard(self) -> None:
        """Remove the files that were written for a run that failed to start."""
        self._check_lock()
        for name in (SCENARIO, COMMANDS, MANIFEST):
            remove(self.path / name)

    def discard_checkpoint(self) -> None:
        """Remove the checkpoint of a run that ended; errors are ignored."""
        with suppress(OSError):
            self._check_lock()
            self._remove_checkpoint()

    def _remove_checkpoint(self) -> None:
        """Remove the listed files of the checkpoint, and the checkpoint folder if it is then empty."""
        folder = self.path / CHECKPOINT
        if self.manifest is None or not is_real_folder(folder):
            return
        for name in self.manifest.checkpoint:  # the state first: without the state, the rows are not valid
            remove(folder / name)
        if not any(folder.iterdir()):
            folder.rmdir()

    def _remove_temporaries(self) -> None:
        """Remove the temporary files of a process that was killed while it held the lock."""
        previous = self._lock.previous
        if previous is None or not previous.token.isalnum():
            return
        prefix = f".partial-{previous.token}-"
        for file in self.path.glob(f"{prefix}*"):
            self._unfinished.add(file.name.removeprefix(prefix))
            remove(file)

    def _remove_earlier_run(self) -> None:
        """Remove the files listed in the manifest, after checking that each may be replaced."""
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


def make_folder(folder: Path) -> None:
    """Create a folder unless it exists; raise OutputNotWritableError if that is impossible."""
    try:
        if exists(folder) and not folder.is_dir():
            raise OutputNotWritableError(
                f"the output path {folder} is {file_kind(folder)}, but must be a folder; choose another path",
                path=str(folder),
            )
        folder.mkdir(parents=True, exist_ok=True)
        next(folder.iterdir(), None)
    except OSError as error:
        if isinstance(error, OutputFolderError):
            raise
        raise not_writable(folder, error) from error


def _is_empty(folder: Path) -> bool:
    """Return True if the folder is empty apart from the lock and temporary files of a killed process."""
    return not any(file.name != LOCK and not file.name.startswith(".partial-") for file in folder.iterdir())


def _as_partial(name: str) -> str:
    """Return the final part of the temporary file name for ``name``."""
    return name.replace("/", "-")


def _removal_order(name: str) -> int:
    return RESULTS.index(name) if name in RESULTS else len(RESULTS)
