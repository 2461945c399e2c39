"""Several files of a folder that are replaced together."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from onorbit_rs.files import partial, refusals, sync_folder
from onorbit_rs.output.manifest import Entry, Manifest

if TYPE_CHECKING:
    from onorbit_rs.output.folder import OutputFolder


class Replacement:
    """Files on their way into a folder: written under temporary names, then renamed all at once."""

    def __init__(self, folder: OutputFolder) -> None:
        """No file yet."""
        self._folder = folder
        self._written: dict[str, tuple[Path, Entry]] = {}

    @contextmanager
    def writing(self, name: str) -> Iterator[Path]:
        """A temporary path for what becomes ``name`` with all the others."""
        file = self._folder.path / name
        with refusals(file):
            self._folder.check_replaceable(name)
            temporary = self._folder.temporary(name)
            with partial(temporary):
                yield temporary
            self._written[name] = temporary, Entry.of(temporary)

    def commit(self) -> None:
        """List the files in the manifest, then give them their names."""
        if not self._written:
            return
        folder = self._folder
        with refusals(folder.path / next(iter(self._written))):
            entries = {name: entry for name, (_, entry) in self._written.items()}
            if folder.manifest is not None:  # a folder of an earlier version stays without
                manifest = folder.manifest
                folder.write_manifest(Manifest({**manifest.files, **entries}, manifest.checkpoint))
            try:
                self._rename()
            except KeyboardInterrupt:  # what was begun is brought to its end
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
        """Remove what was not renamed."""
        for temporary, _ in self._written.values():
            temporary.unlink(missing_ok=True)
