"""Reads mesh files, and caches the most recent meshes while their files are unchanged."""

from __future__ import annotations

import os
import warnings
from functools import lru_cache
from pathlib import Path

import numpy as np

from onorbit_rs.common.input_files import LARGEST_MESH, check_regular, read_bytes
from onorbit_rs.exceptions import ReadError
from onorbit_rs.visuals.meshes.assemble import joined
from onorbit_rs.visuals.meshes.collada import read_collada
from onorbit_rs.visuals.meshes.part import Mesh, Part
from onorbit_rs.visuals.meshes.textures import Companions
from onorbit_rs.visuals.meshes.with_trimesh import read_with_trimesh

ENDINGS = (".dae", ".glb", ".gltf", ".obj", ".ply", ".stl")

_KEPT = 128
"""Number of meshes that are kept in memory."""


def read_mesh(path: str | os.PathLike[str]) -> Mesh:
    """Return the content of a mesh file: Collada, glTF, OBJ, PLY or STL, according to its file extension.

    Materials and textures are searched only near the file; surfaces whose texture is missing have one colour.

    Raises
    ------
    NotFoundError, ReadError
        If the file does not exist, is too large, cannot be read or has no surface; the message states why.
    """
    check_regular(path, "mesh")
    about = Path(path).stat()
    found = _read(Path(path), about.st_mtime_ns, about.st_size)
    if isinstance(found, ReadError):
        raise found
    return found


@lru_cache(_KEPT)
def _read(path: Path, _changed: int, _size: int) -> Mesh | ReadError:
    kind = path.suffix.lower()
    try:
        if kind not in ENDINGS:
            raise ValueError(f"its format is not supported; convert it to one of {', '.join(ENDINGS)}")
        content = read_bytes(path, LARGEST_MESH, "mesh")
        if not content:
            raise ValueError("it is empty; export the mesh again")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # libraries warn about content that they skip
            companions = Companions(path)
            parts = (
                read_collada(content, companions)
                if kind == ".dae"
                else read_with_trimesh(content, kind[1:], companions)
            )
        return Mesh(joined(_checked(parts)))
    except ReadError as error:
        return error
    except ValueError as error:
        return _failure(path, str(error))
    except Exception as error:  # the libraries raise many types for damaged files
        return _failure(path, f"it is damaged ({type(error).__name__}: {error}); export the mesh again")


def _checked(parts: list[Part]) -> list[Part]:
    """Return the parts that have a surface; raise ValueError if no part has a surface."""
    seen = [part for part in parts if len(part.faces) and _has_area(part)]
    if not seen:
        raise ValueError("it has no triangles of nonzero area; export the mesh with its surfaces")
    return seen


def _has_area(part: Part) -> bool:
    a, b, c = (part.vertices[part.faces[:, corner]] for corner in range(3))
    return bool(np.cross(b - a, c - a).any())


def _failure(path: Path, why: str) -> ReadError:
    reason = " ".join(why.split())[:300]
    return ReadError(f"{path} cannot be read: {reason}", path=str(path), kind="mesh")
