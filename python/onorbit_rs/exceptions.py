"""Errors of onorbit_rs, one class per concern.

Every class inherits from :class:`OnOrbitError` and from the built-in class in the table, so that, for
example, ``except ValueError`` also works. Errors are created as ``Cls(message, **fields)``. The fields are
attributes, None if not given, and are preserved by pickling.

==========================  =====================  ==========================================================
class                       built-in               fields: cause
==========================  =====================  ==========================================================
``InputError``              ``ValueError``         ``name, got, expected``: NaN, out of range, not unit norm
``ShapeError``              ``ValueError``         ``name, expected, got``: wrong array length or shape
``DtypeError``              ``TypeError``          ``name, expected, got``: wrong type, such as text
``ModelError``              ``ValueError``         ``link, joint, path``: masses, inertias, loops, bad URDF
``FrameError``              ``KeyError``           ``name, kind, known, suggestion``: no such frame or joint
``OrbitError``              ``ValueError``         ``name, got, expected, time, index``: elements or use
``ElementSetError``         ``OrbitError``         ``line, column, name``: a TLE or OMM that cannot be read
``Sgp4Error``               ``OrbitError``         ``code, time, got``: an error of SGP4, such as decay
``PathError``               ``OrbitError``         ``time, start, end``: invalid path, or time outside of it
``EarthError``              ``ValueError``         ``name, got, expected``: epoch, orientation, ephemeris
``EffectError``             ``ValueError``         ``name, got, expected``: an effect of the environment
``GravityError``            ``ValueError``         ``name, got, expected, path, line``: a gravity field
``ControlError``            ``ValueError``         ``name, got, expected``: gains, controllers, references
``WorldError``              ``ValueError``         ``name, got``: a system, event, brake or contact
``SimulationError``         ``ArithmeticError``    ``time, q, v, trace, name, got, expected``: diverged
``EngineError``             ``ValueError``         ``name, got, expected``: engine missing or wrong setting
``CompareError``            ``ValueError``         ``name, got, expected``: two runs that cannot be compared
``CheckpointError``         ``ValueError``         ``path``: a checkpoint that cannot be resumed
``ConvergenceError``        ``ArithmeticError``    ``iterations, residual``: an iteration or factorisation
``NotFoundError``           ``FileNotFoundError``  ``path, kind, suggestion``: no such file, robot or scenario
``ReadError``               ``OSError``            ``path, kind``: a file cannot be read or is damaged
``IntegrityError``          ``ReadError``          ``path, kind, expected, got``: changed since a run wrote it
``OutputFolderError``       ``OSError``            ``path``: base class of the next three
``OutputInUseError``        ``BlockingIOError``    ``path, pid, command, since``: another process writes to it
``OutputNotEmptyError``     ``FileExistsError``    ``path``: folder has files, or file exists; see ``force``
``OutputNotWritableError``  ``PermissionError``    ``path``: the folder is not writable
``ScenarioError``           ``ValueError``         ``file, path, line, errors``: an invalid scenario
``QuantityError``           ``ValueError``         ``text, expected``: ``"51.6 def"`` is not an angle
``CampaignError``           ``RuntimeError``       ``reason``: a cluster or workers that fail or are lost
``ViewerError``             ``RuntimeError``       ``reason``: the viewer does not start or cannot be shown
``Ros2Error``               ``RuntimeError``       ``reason``: a package, a domain, messages or a node
==========================  =====================  ==========================================================

:class:`RunInterrupted` is a ``KeyboardInterrupt`` (Ctrl-C), so that neither ``except Exception`` nor
``except OnOrbitError`` catches it. Its fields are ``time`` and ``trace``, the trace up to that time.
"""

from __future__ import annotations

from typing import Any

__all__ = [
    "CampaignError",
    "CheckpointError",
    "CompareError",
    "ControlError",
    "ConvergenceError",
    "DtypeError",
    "EarthError",
    "EffectError",
    "ElementSetError",
    "EngineError",
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
    "QuantityError",
    "ReadError",
    "Ros2Error",
    "RunInterrupted",
    "ScenarioError",
    "Sgp4Error",
    "ShapeError",
    "SimulationError",
    "ViewerError",
    "WorldError",
]


class _Fields(BaseException):
    """Error with a message and named fields, both of which are preserved by pickling."""

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
    """Base class of all errors of onorbit_rs."""


class InputError(OnOrbitError, ValueError):
    """Invalid value, such as NaN, infinity, a number out of range, or a quaternion without unit norm."""

    name: Any = None
    got: Any = None
    expected: Any = None


class ShapeError(OnOrbitError, ValueError):
    """Array of the wrong length or shape."""

    name: Any = None
    expected: Any = None
    got: Any = None


class DtypeError(OnOrbitError, TypeError):
    """Argument of the wrong type, such as an array that does not contain real numbers."""

    name: Any = None
    expected: Any = None
    got: Any = None


class ModelError(OnOrbitError, ValueError):
    """Invalid robot: masses, inertias, loops, or an invalid URDF."""

    link: Any = None
    joint: Any = None
    path: Any = None


class FrameError(OnOrbitError, KeyError):
    """Unknown, missing or unsuitable name of a frame, link, body or joint.

    ``known`` has the valid names, or is None.
    """

    name: Any = None
    kind: Any = None
    known: Any = None
    suggestion: Any = None


class OrbitError(OnOrbitError, ValueError):
    """Invalid orbital elements, or an invalid use of an orbit.

    ``time`` is the time of the error, s, if the error depends on time; ``index`` is the index of the orbit in
    a batch.
    """

    name: Any = None
    got: Any = None
    expected: Any = None
    time: Any = None
    index: Any = None


class ElementSetError(OrbitError):
    """Invalid TLE, with the error at ``line`` and ``column`` (from 1), or invalid OMM keyword ``name``."""

    line: Any = None
    column: Any = None


class Sgp4Error(OrbitError):
    """SGP4 has no state at ``time``, s from the epoch; ``code`` is the code of the reference implementation.

    Codes: 1 mean eccentricity, 2 mean motion, 3 perturbed eccentricity, 4 semi-latus rectum, 6 decayed; code
    5 does not occur. ``got`` is the offending value.
    """

    code: Any = None
    time: Any = None


class PathError(OrbitError):
    """Invalid points of a path, or a ``time`` before its ``start`` or after its ``end``, s."""

    time: Any = None
    start: Any = None
    end: Any = None


class EarthError(OnOrbitError, ValueError):
    """Invalid epoch or Earth parameters, or a time outside the data for the Earth, the Sun or the Moon."""

    name: Any = None
    got: Any = None
    expected: Any = None


class WorldError(OnOrbitError, ValueError):
    """Invalid system, event, brake or contact of a world, or an unknown name of one of them."""

    name: Any = None
    got: Any = None


class EffectError(OnOrbitError, ValueError):
    """Invalid effect of the environment."""

    name: Any = None
    got: Any = None
    expected: Any = None


class GravityError(OnOrbitError, ValueError):
    """Invalid gravity field or position; ``path`` and ``line`` locate an error in the coefficient file."""

    name: Any = None
    got: Any = None
    expected: Any = None
    path: Any = None
    line: Any = None


class ControlError(OnOrbitError, ValueError):
    """Invalid or inconsistent gains, controllers or references."""

    name: Any = None
    got: Any = None
    expected: Any = None


class SimulationError(OnOrbitError, ArithmeticError):
    """A run diverged, cannot continue or has ended.

    After a divergence, ``time`` (s), ``q`` and ``v`` are the last state, and ``trace`` has the rows before.
    For a rigid contact without a solution (Painlevé's paradox), ``name`` is the contact, ``got`` its friction
    coefficient, and ``expected`` the largest coefficient for which a contact force exists.
    """

    time: Any = None
    q: Any = None
    v: Any = None
    trace: Any = None
    name: Any = None
    got: Any = None
    expected: Any = None


class EngineError(OnOrbitError, ValueError):
    """A physics engine is not installed, does not support a setting, is already in use, or failed."""

    name: Any = None
    got: Any = None
    expected: Any = None


class CompareError(OnOrbitError, ValueError):
    """Runs of different robots or systems, runs without a common time, or an unknown name in a comparison."""

    name: Any = None
    got: Any = None
    expected: Any = None


class CheckpointError(OnOrbitError, ValueError):
    """Missing or invalid checkpoint, or one of another scenario, version or instruction set."""

    path: Any = None


class ConvergenceError(OnOrbitError, ArithmeticError):
    """An iteration did not converge within ``iterations``, or a matrix could not be factored.

    ``residual`` is the remaining error, or None.
    """

    iterations: Any = None
    residual: Any = None


class NotFoundError(OnOrbitError, FileNotFoundError):
    """A file, a folder, a package or a bundled item does not exist, or a folder contains no run."""

    path: Any = None
    kind: Any = None
    suggestion: Any = None


class ReadError(OnOrbitError, OSError):
    """A file exists but cannot be read, or its content is invalid."""

    path: Any = None
    kind: Any = None


class IntegrityError(ReadError):
    """The size or SHA-256 of a file has changed since the run wrote the file (``expected`` and ``got``)."""

    expected: Any = None
    got: Any = None


class OutputFolderError(OnOrbitError, OSError):
    """The output folder, or an output file, cannot be written."""

    path: Any = None


class OutputInUseError(OutputFolderError, BlockingIOError):
    """Another process is writing to the output folder: its ``pid``, ``command`` and start time ``since``."""

    pid: Any = None
    command: Any = None
    since: Any = None


class OutputNotEmptyError(OutputFolderError, FileExistsError):
    """The output folder already contains files, or an existing output file may not be replaced."""


class OutputNotWritableError(OutputFolderError, PermissionError):
    """The output folder is not writable."""


class ScenarioError(OnOrbitError, ValueError):
    """Invalid scenario, with the location of the error.

    ``file`` is the YAML file, ``path`` the key (``orbit.semi_major_axis``), ``line`` its line, from 1. If the
    scenario has several errors, these attributes are those of the first error, the message has one line per
    error, and ``errors`` contains all of them.
    """

    file: Any = None
    path: Any = None
    line: Any = None
    errors: Any = ()


class QuantityError(OnOrbitError, ValueError):
    """Text that is not a number with a unit of the right dimension."""

    text: Any = None
    expected: Any = None


class CampaignError(OnOrbitError, RuntimeError):
    """The cluster or the workers of a campaign do not start, cannot run its cases, or are lost."""

    reason: Any = None


class ViewerError(OnOrbitError, RuntimeError):
    """The viewer does not start, a notebook cannot contain it, or a recording cannot be encoded."""

    reason: Any = None


class Ros2Error(OnOrbitError, RuntimeError):
    """A package for ROS messages is not installed, a domain cannot be joined, or a node cannot continue."""

    reason: Any = None


class RunInterrupted(_Fields, KeyboardInterrupt):
    """Ctrl-C or another ``KeyboardInterrupt`` at ``time``, s, of a run; ``trace`` has the rows before it."""

    time: Any = None
    trace: Any = None
