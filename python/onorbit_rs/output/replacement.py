"""Replaces several files of a folder together."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from onorbit_rs.common.files import output_errors, partial, sync_folder
from onorbit_rs.output.manifest import Entry, Manifest

if TYPE_CHECKING:
    from onorbit_rs.output.folder import OutputFolder


class Replacement:
    """Files that are written under temporary names and then renamed together."""

    def __init__(self, folder: OutputFolder) -> None:
        """Start an empty group of files in ``folder``."""
        self._folder = folder
        self._written: dict[str, tuple[Path, Entry]] = {}

    @contextmanager
    def writing(self, name: str) -> Iterator[Path]:
        """Yield the path of a temporary file, which :meth:`commit` renames to ``name``.

        Raises OutputFolderError if the temporary file cannot be written, or if an existing file ``name`` may
        not be replaced.
        """
        file = self._folder.path / name
        with output_errors(file):
            self._folder.check_replaceable(name)
            temporary = self._folder.temporary(name)
            with partial(temporary):
                yield temporary
            self._written[name] = temporary, Entry.of(temporary)

    def commit(self) -> None:
        """Add the files to the manifest, if the folder has one, and rename them.

        Raises OutputFolderError if the manifest or a file cannot be written.
        """
        if not self._written:
            return
        folder = self._folder
        with output_errors(folder.path / next(iter(self._written))):
            entries = {name: entry for name, (_, entry) in self._written.items()}
            if folder.manifest is not None:  # folders of earlier versions have no manifest
                manifest = folder.manifest
                folder.write_manifest(Manifest({**manifest.files, **entries}, manifest.checkpoint))
            try:
                self._rename()
            except KeyboardInterrupt:  # all files are renamed before the run stops
                self._rename()
                raise
            for parent in {folder.path, *((folder.path / name).parent for name in entries)}:
                sync_folder(parent)

    def _rename(self) -> None:
        for name, (temporary, _) in list(self._written.items()):
            file = self._folder.path / name
            file.parent.mkdir(exist_ok=True)
            if temporary.exists():
                temporary.replace(file)
            del self._written[name]

    def discard(self) -> None:
        """Remove the files that were not renamed."""
        for temporary, _ in self._written.values():
            temporary.unlink(missing_ok=True)
