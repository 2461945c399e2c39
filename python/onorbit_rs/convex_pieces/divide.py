"""Divides a closed mesh into convex pieces with CoACD, in a separate process."""

from __future__ import annotations

import hashlib
import importlib.metadata
import io
import json
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from onorbit_rs.convex_pieces import cache
from onorbit_rs.convex_pieces.fit import fitted
from onorbit_rs.exceptions import ModelError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

OPTIONS = {"threshold": 0.02, "seed": 0}
"""Options of CoACD. The threshold is the accepted concavity relative to half the size of the mesh."""

VERSION = 1
"""Version of the method; to be increased when the results of the method change."""

PROGRAM = Path(__file__).with_name("program.py")

MANY = 3000
"""Smallest number of triangles of a mesh whose division may take minutes."""

_known: dict[str, list[Floats]] = {}
"""Results of this process by key, in case the cache cannot be written."""


def pieces_of(
    vertices: Floats, triangles: Sequence[Sequence[int]], count: int, filename: str
) -> list[Floats]:
    """Return the corners (k, 3), m, of at most ``count`` convex pieces of a closed mesh with outward normals.

    Equal arguments give equal bits, whether the result is computed or cached.

    Raises
    ------
    ModelError
        If CoACD is not installed or fails.
    """
    try:
        library = importlib.metadata.version("coacd")
    except importlib.metadata.PackageNotFoundError:
        raise ModelError(
            f"{filename}: convex pieces of a mesh require CoACD, which is not installed: "
            "pip install 'onorbit-rs[meshes]'",
            path=filename,
        ) from None
    points = np.ascontiguousarray(vertices, dtype=np.float64)
    corners = np.ascontiguousarray(triangles, dtype=np.int32)
    options = OPTIONS | {"max_convex_hull": count}
    key = _key(library, options, points, corners)
    found = _known.get(key) or cache.read(key)
    if found is None:
        _announce(filename, len(corners))
        found = fitted(_divided(points, corners, options, filename), points, corners)
        cache.write(key, found)
    _known[key] = found
    return found


def _key(library: str, options: dict[str, float], points: Floats, corners: NDArray[np.int32]) -> str:
    """Return the key of the pieces in the cache, which depends on all arguments."""
    settings = json.dumps([VERSION, library, options, points.shape, corners.shape], sort_keys=True)
    return hashlib.sha256(settings.encode() + points.tobytes() + corners.tobytes()).hexdigest()


def _announce(filename: str, triangles: int) -> None:
    """Write a line on a terminal if the division may take long."""
    if triangles >= MANY and sys.stderr is not None and sys.stderr.isatty():
        kept = cache.folder()
        remark = f"; the result is kept in {kept}" if kept else ""
        sys.stderr.write(
            f"dividing {filename} ({triangles} triangles) into convex pieces may take minutes{remark}\n"
        )


def _divided(
    points: Floats, corners: NDArray[np.int32], options: dict[str, float], filename: str
) -> list[Floats]:
    """Return CoACD's pieces, computed in a separate process, so that a crash of CoACD is only an error."""
    given = io.BytesIO()
    np.savez(given, vertices=points, triangles=corners)
    command = [sys.executable, "-P", str(PROGRAM), json.dumps(options)]
    done = subprocess.run(command, input=given.getvalue(), capture_output=True, check=False)
    if done.returncode != 0:
        last = done.stderr.decode(errors="replace").strip().splitlines()[-1:]
        reason = last[0] if last else f"its process ended with the code {done.returncode}"
        raise ModelError(
            f"{filename}: CoACD failed to divide the mesh into convex pieces ({reason}); simplify the mesh, "
            "or omit 'pieces' to use its convex hull",
            path=filename,
        )
    return cache.split(np.load(io.BytesIO(done.stdout), allow_pickle=False))
