"""Names and paths of the files that are part of the package."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from onorbit_rs.common.suggestions import did_you_mean, nearest
from onorbit_rs.exceptions import NotFoundError


class BundledFiles(NamedTuple):
    """Files of one kind in a folder of the package.

    ``kind`` is the word for such a file in messages, such as ``robot``, and ``ending`` the end of its name.
    """

    kind: str
    folder: Path
    ending: str

    def names(self) -> list[str]:
        """Return the sorted names, without the ending."""
        return sorted(file.stem for file in self.folder.glob(f"*{self.ending}"))

    def path(self, name: str) -> Path:
        """Return the path of a bundled file.

        Raises
        ------
        NotFoundError
            If there is no such file; the message suggests a similar name, if there is one.
        """
        known = self.names()
        if name not in known:
            hint = did_you_mean(name, known) or "; onorbit list prints the names"
            message = f"no bundled {self.kind} is named {name!r}{hint}"
            raise NotFoundError(message, path=name, kind=self.kind, suggestion=nearest(name, known))
        return self.folder / f"{name}{self.ending}"

    def locate(self, source: str | os.PathLike[str]) -> Path:
        """Return the file of a bundled name or a path; a file in the working folder has precedence.

        Raises
        ------
        NotFoundError
            If there is no such file and no such name; the message suggests a similar name, if there is one.
        """
        name, known = os.fspath(source), self.names()
        if not name:
            raise NotFoundError(
                f"the name of the {self.kind} is empty; give a bundled name or a YAML file",
                path="", kind=self.kind,
            )  # fmt: skip
        path = Path(name)
        if path.is_file() or (path.exists() and path.name not in known):
            return path
        if name in known:
            return self.path(name)
        hint = did_you_mean(path.stem, known) or "; onorbit list prints the bundled names"
        raise NotFoundError(
            f"no such {self.kind}: {name!r} is neither a file nor a bundled name{hint}",
            path=name, kind=self.kind,
        )  # fmt: skip
