"""Images and materials to which a mesh file refers; only local files near the mesh are read."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from onorbit_rs.common.input_files import read_bytes
from onorbit_rs.exceptions import OnOrbitError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

LARGEST_COMPANION = 64_000_000
"""Largest size of an image or a material file, bytes."""

MOST_PIXELS = 64_000_000
SIDE = 1024
"""Largest number of pixels along the longer side of a texture; larger textures are reduced."""

_FORMATS = ("PNG", "JPEG", "BMP", "GIF", "TGA", "TIFF", "WEBP")
"""Formats that Pillow decodes without other programs such as Ghostscript."""

_UP = 4
"""Number of folders, from that of the mesh upwards, in which its package is searched."""


class Companions:
    """Files to which a mesh refers, with the methods of a trimesh resolver.

    Only files in the package of the mesh (a folder with ``package.xml`` or ``model.config``) are read or,
    without a package, files in the parent of its folder. Symbolic links are resolved first.
    """

    def __init__(self, mesh: Path) -> None:
        """Find the package of a mesh file."""
        self._known: dict[str, NDArray[np.uint8] | None] = {}
        self._folder = mesh.parent.resolve()
        above = [self._folder, *self._folder.parents][:_UP]
        package = (folder for folder in above if _is_package(folder))
        self._root = next(package, self._folder.parent)
        if self._root == self._root.parent:  # the root folder would allow the whole disk
            self._root = self._folder

    def get(self, name: str) -> bytes:
        """Return the content of a file; raise FileNotFoundError if the package does not contain the file."""
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
        """Return this object, as trimesh requires for folders in archives, which are not supported."""
        return self

    def _places(self, name: str) -> Iterator[Path]:
        if "://" in name:  # an address on the network
            return
        yield self._folder / name
        last = name.rpartition("/")[2]
        for folder in ("", "textures", "../textures", "../materials/textures"):
            yield self._folder / folder / last

    def texture(self, name: str) -> NDArray[np.uint8] | None:
        """Return the pixels (h, w, 3) of an image file, cached by name; None if it cannot be read."""
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
    """Return the pixels (h, w, 3) of a Pillow image that has not been decoded yet; None if it is unusable."""
    import numpy as np

    if image is None or image.format not in _FORMATS or math.prod(image.size) > MOST_PIXELS:
        return None
    try:
        image.thumbnail((SIDE, SIDE))
        return np.asarray(image.convert("RGB"))
    except (OSError, ValueError, SyntaxError):  # a damaged picture
        return None


def as_utf8(content: bytes) -> bytes:
    """Return text as UTF-8; other encodings are read as Latin-1, since numbers and keywords are ASCII."""
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return content.decode("latin-1").encode("utf-8")
    return content


def _is_package(folder: Path) -> bool:
    return (folder / "package.xml").is_file() or (folder / "model.config").is_file()
