"""Fuzz targets in Python: each parses bytes or raises an ``OnOrbitError``."""

from __future__ import annotations

import contextlib
import json
import re
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from pausing import Pausing

import onorbit_rs as oo
from onorbit_rs import _core
from onorbit_rs.ephemeris import omm as _omm  # noqa: F401
from onorbit_rs.ephemeris import spice as _kernel  # noqa: F401  # loaded late else, when coverage is set up
from onorbit_rs.exceptions import IntegrityError, NotFoundError, RunInterrupted
from onorbit_rs.output.folder import OutputFolder
from onorbit_rs.output.manifest import Manifest, read_manifest
from onorbit_rs.output.read import read_summary, read_trace
from onorbit_rs.output.sealed import sealed
from onorbit_rs.report.numbers import groups
from onorbit_rs.robots.expand import expand
from onorbit_rs.scenario import load
from onorbit_rs.scenario.build import build
from onorbit_rs.scenario.load import check
from onorbit_rs.scenario.orbit.custom_path import CustomPathOrbit
from onorbit_rs.scenario.orbit.sgp4 import two_lines
from onorbit_rs.scenario.units import ANGLE, FORCE, GRAVITY, LENGTH, NUMBER, TIME, parse_quantity
from onorbit_rs.scenario.yaml_lines import parse_yaml
from onorbit_rs.simulation import finish
from onorbit_rs.simulation.controller_state import decode, encode
from onorbit_rs.tools.interop.expressions import evaluate
from onorbit_rs.tools.interop.onorbitros import convert
from onorbit_rs.visuals.meshes import read_mesh

# the figures of a resumed run take most of a second and parse nothing
finish.write_pictures = lambda *_, **__: None

SHORT_RUN = {
    "robot": {"rigid_body": {"mass": 1.0, "inertia": [1.0, 2.0, 3.0]}},
    "initial": {"angular_velocity": [0.1, 0.0, 0.0]},
    "simulation": {"duration": 0.02, "time_step": 1e-4},
}
STOPPED_RUN = SHORT_RUN | {
    "controller": {"kind": "python", "module": "pausing", "class": "Pausing"},
    "simulation": {"duration": 0.4, "time_step": 1e-3},
}


class Room:
    """A temporary folder of this process with a file of the bytes under test."""

    def __init__(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="onorbit-fuzz-"))
        self._runs: dict[bool, Path] = {}

    def file(self, name: str, data: bytes) -> Path:
        path = self.folder / name
        path.write_bytes(data)
        return path

    def run(self, *, stopped: bool) -> Path:
        """Returns a new copy of the folder of a short run, or of a run that was interrupted."""
        if stopped not in self._runs:
            self._runs[stopped] = self._made(stopped)
        copy = self.folder / "copy"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(self._runs[stopped], copy)
        return copy

    def _made(self, stopped: bool) -> Path:
        folder = self.folder / f"run{stopped:d}"
        if not stopped:
            oo.run(SHORT_RUN, folder, quiet=True)
            return folder
        Pausing.stops = True
        try:
            with contextlib.suppress(RunInterrupted):
                oo.run(STOPPED_RUN, folder, quiet=True, checkpoint_every=0.0)
        finally:
            Pausing.stops = False
        if not (folder / "checkpoint" / "state.json").exists():
            raise RuntimeError("the run was stopped and left no checkpoint")
        return folder

    def close(self) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)


def text(data: bytes) -> str:
    return data.decode("utf-8", errors="replace")


def all_finite(what: str, *arrays: Any) -> None:
    """Fails if accepted input yields non-finite numbers."""
    for array in arrays:
        if not np.all(np.isfinite(array)):
            raise AssertionError(f"{what} were accepted, but they give numbers that are not finite: {array}")


def quantity(data: bytes, room: Room) -> None:
    dimensions = (NUMBER, LENGTH, TIME, ANGLE, FORCE, GRAVITY)
    allowed = dimensions[data[0] % len(dimensions)] if data else NUMBER
    all_finite("quantities are", parse_quantity(text(data[1:]), allowed))


def expression(data: bytes, room: Room) -> None:
    all_finite("expressions are", evaluate(text(data)))


def yaml(data: bytes, room: Room) -> None:
    parse_yaml(text(data), None)


def scenario(data: bytes, room: Room) -> None:
    build(load(room.file("scenario.yaml", data)))


def mean_elements(data: bytes, room: Room) -> None:
    all_finite("elements are", *_core.Sgp4.from_omm(text(data)).state(60.0)[:2])


def tle_file(data: bytes, room: Room) -> None:
    all_finite("elements are", *_core.Sgp4(*two_lines(text(data), "file")).state(60.0)[:2])


def point_file(data: bytes, room: Room) -> None:
    path = CustomPathOrbit(file=room.file("points.csv", data), ends="coast").build(Path())
    all_finite("points are", *path.state(0.0)[:2])


def spice_kernel(data: bytes, room: Room) -> None:
    oo.Earth("2024-01-10T12:00:00 UTC", ephemeris=room.file("kernel.bsp", data))


def onorbitros(data: bytes, room: Room) -> None:
    robot = room.file("robot.urdf", b"<robot name='r'/>")
    check(convert([room.file("orbit.yaml", data), robot]).scenario, None, {})


def trace(data: bytes, room: Room) -> None:
    room.file("trace.npz", data)
    read_trace(room.folder)


def summary(data: bytes, room: Room) -> None:
    room.file("summary.json", data)
    groups(read_summary(room.folder))


def resealed(data: bytes) -> bytes:
    """Corrects the checksum of a mapping, so that its entries are read."""
    with contextlib.suppress(ValueError, RecursionError):
        record = json.loads(data)
        if isinstance(record, dict):
            return sealed({key: value for key, value in record.items() if key != "sha256"})
    return data


def checkpoint(data: bytes, room: Room) -> None:
    """Resumes from the checkpoint of an interrupted run."""
    folder = room.run(stopped=True)
    (folder / "checkpoint" / "state.json").write_bytes(resealed(data))
    oo.resume(folder, quiet=True)


def controller_state(data: bytes, room: Room) -> None:
    """Parses a Python controller's state in a checkpoint; writing and reading it again must not change it."""
    text = encode(decode(data))
    if encode(decode(text)) != text:
        raise AssertionError(f"reading {text!r} and writing it again changes it")


def manifest(data: bytes, room: Room) -> None:
    """Parses the list of a run's files; ``--force`` must remove only these."""
    folder = room.run(stopped=b'"checkpoint": []' not in data)
    (folder / "manifest.json").write_bytes(resealed(data))
    (folder / "figures").mkdir(exist_ok=True)
    others = [folder / "notes.txt", folder / "figures" / "notes.txt", folder.parent / "notes.txt"]
    for file in others:
        file.write_text("not of the run")
    listed = read_manifest(folder)
    (folder / "manifest.json").write_bytes((listed or Manifest()).as_bytes())
    if read_manifest(folder) != listed:
        raise AssertionError(f"reading {listed} and writing it again changes it")
    with contextlib.suppress(IntegrityError, NotFoundError):
        read_summary(folder)
        read_trace(folder)
    OutputFolder.claim(folder, force=True).close()
    if not all(file.exists() for file in others):
        raise AssertionError(f"with {listed}, --force removes files that no run has written")


def xacro(data: bytes, room: Room) -> None:
    expand(room.file("robot.xacro", data))


def mesh(data: bytes, room: Room) -> None:
    """Parses a mesh; the first line is the file's extension."""
    ending, _, content = data.partition(b"\n")
    found = read_mesh(room.file(f"mesh.{re.sub(r'[^a-z0-9]', '', text(ending))}", content))
    for part in found.parts:
        all_finite("vertices and normals are", part.vertices, part.normals, part.face_colors)


def urdf_file(data: bytes, room: Room) -> None:
    oo.Model.from_urdf(room.file("robot.urdf", data))


Target = Callable[[bytes, Room], None]

TARGETS: dict[str, Target] = {
    target.__name__: target
    for target in (
        quantity, expression, yaml, scenario, mean_elements, tle_file, point_file, spice_kernel, onorbitros,
        trace, summary, manifest, checkpoint, controller_state, xacro, mesh, urdf_file,
    )
}  # fmt: skip


def seeds(name: str, room: Room) -> list[bytes]:
    """Returns inputs that depend on the version of the package, in addition to the corpus."""
    if name == "checkpoint":
        return [(room.run(stopped=True) / "checkpoint" / "state.json").read_bytes()]
    if name == "manifest":
        return [(room.run(stopped=stopped) / "manifest.json").read_bytes() for stopped in (False, True)]
    if name in ("trace", "summary"):
        file = {"trace": "trace.npz", "summary": "summary.json"}[name]
        return [(room.run(stopped=False) / file).read_bytes()]
    if name == "scenario":
        return [
            oo.scenarios.path(name).read_bytes() for name in ("free_tumble", "kepler_orbit", "sgp4_orbit")
        ]
    return []
