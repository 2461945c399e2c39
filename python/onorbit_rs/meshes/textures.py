"""Pictures and materials that a mesh file names: local files near it, and nothing else."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from onorbit_rs.exceptions import OnOrbitError
from onorbit_rs.reading import read_bytes

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

LARGEST_COMPANION = 64_000_000
"""Bytes of a picture or a list of materials."""

MOST_PIXELS = 64_000_000
SIDE = 1024
"""Pixels along a side that a texture keeps at most."""

_FORMATS = ("PNG", "JPEG", "BMP", "GIF", "TGA", "TIFF", "WEBP")
"""Those that Pillow reads by itself; others it hands to programs such as Ghostscript."""

_UP = 4
"""Folders above a mesh in which its package is looked for."""


class Companions:
    """The files beside a mesh, as trimesh asks for them (``get``).

    Only those below the folder of its package (with ``package.xml`` or ``model.config``), else below the
    folder above its own, after symbolic links are followed.
    """

    def __init__(self, mesh: Path) -> None:
        """Of the mesh in a file."""
        self._known: dict[str, NDArray[np.uint8] | None] = {}
        self._folder = mesh.parent.resolve()
        above = [self._folder, *self._folder.parents][:_UP]
        package = (folder for folder in above if _is_package(folder))
        self._root = next(package, self._folder.parent)
        if self._root == self._root.parent:  # all of the disk
            self._root = self._folder

    def get(self, name: str) -> bytes:
        """The content of a file; FileNotFoundError where it is not near the mesh."""
        for path in self._places(unquote(name.strip()).removeprefix("file://").replace("\\", "/")):
            try:
                if path.resolve().is_relative_to(self._root) and path.is_file():
                    content = read_bytes(path, LARGEST_COMPANION, "texture")
                    return as_utf8(content) if path.suffix.lower() == ".mtl" else content
            except (OSError, ValueError, OnOrbitError):
                continue
        raise FileNotFoundError(name)

    __getitem__ = get

    def namespaced(self, _: str) -> Companions:
        """Of a folder in an archive: the same, since there are no archives here."""
        return self

    def _places(self, name: str) -> Iterator[Path]:
        if "://" in name:  # on the network
            return
        yield self._folder / name
        last = name.rpartition("/")[2]
        for folder in ("", "textures", "../textures", "../materials/textures"):
            yield self._folder / folder / last

    def texture(self, name: str) -> NDArray[np.uint8] | None:
        """(h, w, 3) of a picture file, None where it is not there or no picture; the same for one name."""
        if name not in self._known:
            self._known[name] = self._decoded(name)
        return self._known[name]

    def _decoded(self, name: str) -> NDArray[np.uint8] | None:
        from PIL import Image

        try:
            return pixels(Image.open(io.BytesIO(self.get(name)), formats=_FORMATS))
        except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
            return None


def pixels(image: Any) -> NDArray[np.uint8] | None:
    """(h, w, 3) of a Pillow image that has not been decoded yet."""
    import numpy as np

    if image is None or image.format not in _FORMATS or math.prod(image.size) > MOST_PIXELS:
        return None
    try:
        image.thumbnail((SIDE, SIDE))
        return np.asarray(image.convert("RGB"))
    except (OSError, ValueError, SyntaxError):  # a damaged picture
        return None


def as_utf8(content: bytes) -> bytes:
    """Text in any encoding with ASCII in it: numbers and key words are that, and remarks do not count."""
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return content.decode("latin-1").encode("utf-8")
    return content


def _is_package(folder: Path) -> bool:
    return (folder / "package.xml").is_file() or (folder / "model.config").is_file()
