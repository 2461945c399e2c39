"""Reads recordings with rerun's reader (``rerun rrd verify`` ignores invalid content)."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rerun.chunk import RrdReader

from onorbit_rs.common.rotations import matrix_from_quaternion

Floats = NDArray[np.float64]


def chunks(path: Path) -> list[Any]:
    return list(RrdReader(path).stream().to_chunks())


def rows_by_entity(path: Path) -> tuple[Counter[str], Counter[str]]:
    """Returns the number of rows per entity, over time and static."""
    moving, static = Counter[str](), Counter[str]()
    for chunk in chunks(path):
        (static if chunk.is_static else moving)[chunk.entity_path] += chunk.num_rows
    return moving, static


def column(path: Path, entity: str, component: str, *, static: bool = False) -> list[Any]:
    """Returns the rows of a component in order of time."""
    found: list[tuple[int, Any]] = []
    for chunk in chunks(path):
        batch = chunk.to_record_batch()
        if chunk.entity_path != entity or chunk.is_static != static or component not in batch.schema.names:
            continue
        times = [0] * batch.num_rows
        if not static:
            times = batch.column("simulation_time").cast("int64").to_pylist()
        values = batch.column(component).to_pylist()
        found += [pair for pair in zip(times, values, strict=True) if pair[1] is not None]
    return [value for _, value in sorted(found, key=lambda pair: pair[0])]


class FrameTree:
    """The named frames of a recording: the parent of each frame and its pose at every row."""

    def __init__(self, path: Path) -> None:
        self.parents: dict[str, str] = {}
        self._poses: dict[str, Floats] = {}
        for chunk in chunks(path):
            batch = chunk.to_record_batch()
            if "Transform3D:child_frame" not in batch.schema.names:
                continue
            names = [name for name in batch.schema.names if name.startswith("Transform3D:")]
            parts = {name.split(":")[-1]: batch.column(name).to_pylist() for name in names}
            child, parent = ({row[0] for row in parts[f"{name}_frame"]} for name in ("child", "parent"))
            assert len(child) == len(parent) == 1, chunk.entity_path
            (name,), (self.parents[name],) = child, parent
            poses = np.tile(np.eye(4), (batch.num_rows, 1, 1))
            poses[:, :3, 3] = [row[0] for row in parts["translation"]]
            poses[:, :3, :3] = matrix_from_quaternion([row[0] for row in parts["quaternion"]])
            self._poses[name] = np.concatenate([self._poses[name], poses]) if name in self._poses else poses

    def pose(self, frame: str, root: str = "W") -> Floats:
        """Returns the poses (T, 4, 4) of a frame, or (1, 4, 4) of a static frame."""
        if frame == root:
            return np.eye(4)[None]
        return self.pose(self.parents[frame], root) @ self._poses[frame]
