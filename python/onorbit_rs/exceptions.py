"""Every error of onorbit_rs, one class per concern.

Each class is an :class:`OnOrbitError` and also the built-in that fits, so ``except ValueError`` works too.
Each is made as ``Cls(message, **fields)``; fields are attributes, ``None`` where not given, and all pickle.

==========================  =====================  ==========================================================
class                       built-in               fields
==========================  =====================  ==========================================================
``InputError``              ``ValueError``         ``name, got, expected``: NaN, out of range, not unit norm
``ShapeError``              ``ValueError``         ``name, expected, got``: wrong array length or shape
``DtypeError``              ``TypeError``          ``name, expected, got``: not an array of real numbers
``ModelError``              ``ValueError``         ``link, joint, path``: masses, inertias, loops, bad URDF
``FrameError``              ``KeyError``           ``name, kind, known, suggestion``: no such frame or joint
``OrbitError``              ``ValueError``         ``name, got, expected``: no orbit, or gravity refused
``ElementSetError``         ``OrbitError``         ``line, column, name``: a TLE or OMM that cannot be read
``Sgp4Error``               ``OrbitError``         ``code, time, got``: what SGP4 refuses, decay included
``PathError``               ``OrbitError``         ``time, start, end``: no path, or none at that time
``EarthError``              ``ValueError``         ``name, got, expected``: epochs, the Earth's turn, sky
``EffectError``             ``ValueError``         ``name, got, expected``: an effect of the environment
``GravityError``            ``ValueError``         ``name, got, expected, path, line``: a field, a file
``ControlError``            ``ValueError``         ``name, got, expected``: gains, controllers, references
``SimulationError``         ``ArithmeticError``    ``time, q, v, trace``: the run diverged
``PlantError``              ``ValueError``         ``name, got, expected``: another physics engine's limits
``CompareError``            ``ValueError``         ``name, got, expected``: two runs that cannot be compared
``CheckpointError``         ``ValueError``         ``path``: broken, or of another run: no going on from it
``ConvergenceError``        ``ArithmeticError``    ``iterations, residual``: an iteration or factorisation
``NotFoundError``           ``FileNotFoundError``  ``path, kind, suggestion``: no such file, robot or scenario
``ReadError``               ``OSError``            ``path, kind``: a file is there but cannot be read
``IntegrityError``          ``ReadError``          ``path, kind, expected, got``: changed since a run wrote it
``OutputFolderError``       ``OSError``            ``path``: base of the three below
``OutputInUseError``        ``BlockingIOError``    ``path, pid, command, since``: another process writes it
``OutputNotEmptyError``     ``FileExistsError``    ``path``: the folder holds files; ask with ``force``
``OutputNotWritableError``  ``PermissionError``    ``path``: the folder cannot be written
``ScenarioError``           ``ValueError``         ``file, path, line``: a YAML broken, misspelt or senseless
``QuantityError``           ``ValueError``         ``text, expected``: ``"51.6 def"`` is no angle
``ViewerError``             ``RuntimeError``       ``reason``: the viewer does not start or shows nothing
==========================  =====================  ==========================================================

:class:`RunInterrupted` stands apart: it is a ``KeyboardInterrupt`` (Ctrl-C), so neither ``except Exception``
nor ``except OnOrbitError`` swallows it; its fields are ``time`` and ``trace``, the run so far.
"""

from __future__ import annotations

from typing import Any

__all__ = [
    "CheckpointError",
    "CompareError",
    "ControlError",
    "ConvergenceError",
    "DtypeError",
    "EarthError",
    "EffectError",
    "ElementSetError",
    "FrameError",
    "GravityError",
    "InputError",
    "IntegrityError",
    "ModelError",
    "NotFoundError",
    "OnOrbitError",
    "OrbitError",
    "OutputFolderError",
    "OutputInUseError",
    "OutputNotEmptyError",
    "OutputNotWritableError",
    "PathError",
    "PlantError",
    "QuantityError",
    "ReadError",
    "RunInterrupted",
    "ScenarioError",
    "Sgp4Error",
    "ShapeError",
    "SimulationError",
    "ViewerError",
]


class _Fields(BaseException):
    """A message and named fields; survives pickling with both."""

    def __init__(self, message: str = "", **fields: Any) -> None:
        super().__init__(message)
        self.message = message
        for name, value in fields.items():
            setattr(self, name, value)

    def __str__(self) -> str:  # KeyError and OSError would print a repr or an errno
        return self.message

    def __reduce__(self) -> tuple[Any, ...]:
        return (_rebuild, (type(self), self.message, self.__dict__))


def _rebuild(cls: type[_Fields], message: str, fields: dict[str, Any]) -> _Fields:
    return cls(message, **{name: value for name, value in fields.items() if name != "message"})


class OnOrbitError(_Fields, Exception):
    """Root of every error of onorbit_rs."""


class InputError(OnOrbitError, ValueError):
    """A value without physical sense: NaN, infinite, out of range, a quaternion off unit norm."""

    name: Any = None
    got: Any = None
    expected: Any = None


class ShapeError(OnOrbitError, ValueError):
    """An array of the wrong length or shape."""

    name: Any = None
    expected: Any = None
    got: Any = None


class DtypeError(OnOrbitError, TypeError):
    """Not an array of real numbers."""

    name: Any = None
    expected: Any = None
    got: Any = None


class ModelError(OnOrbitError, ValueError):
    """A robot that cannot be: masses, inertias, loops, a malformed URDF."""

    link: Any = None
    joint: Any = None
    path: Any = None


class FrameError(OnOrbitError, KeyError):
    """No frame, link, body or joint has this name."""

    name: Any = None
    kind: Any = None
    known: Any = None
    suggestion: Any = None


class OrbitError(OnOrbitError, ValueError):
    """Elements that describe no orbit, or an orbit that cannot be used so.

    ``time`` where there is one, s; ``index`` of the orbit among many.
    """

    name: Any = None
    got: Any = None
    expected: Any = None
    time: Any = None
    index: Any = None


class ElementSetError(OrbitError):
    """A TLE or OMM that cannot be read: ``line`` and ``column`` (from 1) of a TLE, ``name`` of an entry."""

    line: Any = None
    column: Any = None


class Sgp4Error(OrbitError):
    """SGP4 has no state at ``time``, s from the epoch: ``code`` is the reference code's error number.

    1 mean eccentricity, 2 mean motion, 3 perturbed eccentricity, 4 semi-latus rectum, 6 decayed; 5 is no
    longer raised. ``got`` is the offending value.
    """

    code: Any = None
    time: Any = None


class PathError(OrbitError):
    """Points that make no path; or a ``time`` before its ``start`` or after its ``end``, s."""

    time: Any = None
    start: Any = None
    end: Any = None


class EarthError(OnOrbitError, ValueError):
    """An epoch, a time or parameters for which nobody knows how the Earth or the sky stands."""

    name: Any = None
    got: Any = None
    expected: Any = None


class EffectError(OnOrbitError, ValueError):
    """An effect of the environment that makes no sense."""

    name: Any = None
    got: Any = None
    expected: Any = None


class GravityError(OnOrbitError, ValueError):
    """A gravity field that cannot be, or a place where it does not hold; ``path`` and ``line`` of a file."""

    name: Any = None
    got: Any = None
    expected: Any = None
    path: Any = None
    line: Any = None


class ControlError(OnOrbitError, ValueError):
    """Gains, controllers or references that do not fit."""

    name: Any = None
    got: Any = None
    expected: Any = None


class SimulationError(OnOrbitError, ArithmeticError):
    """The run diverged; ``trace`` holds what was recorded until then."""

    time: Any = None
    q: Any = None
    v: Any = None
    trace: Any = None


class PlantError(OnOrbitError, ValueError):
    """Another physics engine that is not there, or that cannot do what it is asked for."""

    name: Any = None
    got: Any = None
    expected: Any = None


class CompareError(OnOrbitError, ValueError):
    """Two runs that have nothing to compare: another robot, no time in common."""

    name: Any = None
    got: Any = None
    expected: Any = None


class CheckpointError(OnOrbitError, ValueError):
    """A run cannot go on from its checkpoint: broken, or of another scenario, version or instruction set."""

    path: Any = None


class ConvergenceError(OnOrbitError, ArithmeticError):
    """An iteration did not converge, or a matrix could not be factored."""

    iterations: Any = None
    residual: Any = None


class NotFoundError(OnOrbitError, FileNotFoundError):
    """No such file, bundled robot or bundled scenario."""

    path: Any = None
    kind: Any = None
    suggestion: Any = None


class ReadError(OnOrbitError, OSError):
    """The file is there but cannot be read."""

    path: Any = None
    kind: Any = None


class IntegrityError(ReadError):
    """A file of a run differs from what the run wrote, by size or SHA-256 (``expected`` and ``got``)."""

    expected: Any = None
    got: Any = None


class OutputFolderError(OnOrbitError, OSError):
    """The output folder cannot be used."""

    path: Any = None


class OutputInUseError(OutputFolderError, BlockingIOError):
    """Another process writes the output folder: its ``pid``, its ``command``, and ``since`` when."""

    pid: Any = None
    command: Any = None
    since: Any = None


class OutputNotEmptyError(OutputFolderError, FileExistsError):
    """The output folder already holds files."""


class OutputNotWritableError(OutputFolderError, PermissionError):
    """The output folder cannot be written."""


class ScenarioError(OnOrbitError, ValueError):
    """A scenario that is broken, misspelt or makes no sense; says where.

    ``file`` is the YAML, ``path`` the place in it (``orbit.semi_major_axis``), ``line`` its line, from 1.
    """

    file: Any = None
    path: Any = None
    line: Any = None


class QuantityError(OnOrbitError, ValueError):
    """Text that is not a number with a unit of the right dimension."""

    text: Any = None
    expected: Any = None


class ViewerError(OnOrbitError, RuntimeError):
    """The viewer, a program of its own, does not start here or shows nothing."""

    reason: Any = None


class RunInterrupted(_Fields, KeyboardInterrupt):
    """Ctrl-C during a run; ``trace`` holds the run so far."""

    time: Any = None
    trace: Any = None
