"""Functions that run a scenario, :func:`run`, and resume an interrupted run, :func:`resume`."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from onorbit_rs.common.files import exists
from onorbit_rs.common.numbers import finite_float
from onorbit_rs.common.progress import doing, progress_bar
from onorbit_rs.common.user_warnings import warn_user
from onorbit_rs.engines import versions
from onorbit_rs.exceptions import (
    InputError,
    ModelError,
    NotFoundError,
    RunInterrupted,
    SimulationError,
)
from onorbit_rs.output import (
    CheckpointWriter,
    OutputFolder,
    read_checkpoint,
    scenario_digest,
    with_absolute_paths,
    write_scenario,
)
from onorbit_rs.output.read import check_folder
from onorbit_rs.output.robot import CHANGED, was_changed
from onorbit_rs.output.write import ALL, Outputs
from onorbit_rs.scenario import Scenario, WorldScenario, load
from onorbit_rs.scenario.build import Built, build
from onorbit_rs.scenario.build_world import BuiltWorld, build_world
from onorbit_rs.simulation.command_files import saved_commands, warnings_without, write_commands
from onorbit_rs.simulation.command_format import Command, in_order, read_commands
from onorbit_rs.simulation.command_format import checked as checked_command
from onorbit_rs.simulation.finish import finished, keep_failed, keep_stopped
from onorbit_rs.simulation.live import CHECKPOINT_EVERY, watched
from onorbit_rs.simulation.memory import check_size, is_streamed
from onorbit_rs.simulation.replay import check_commands
from onorbit_rs.simulation.streaming import is_bounded, streamed

if TYPE_CHECKING:
    from onorbit_rs._core import Model, Trace, WorldTrace


@dataclass(frozen=True, repr=False)
class Run:
    """Results of a run.

    A run can be pickled, for :mod:`multiprocessing`; the robot is then loaded again on access.

    Attributes
    ----------
    trace : Trace or WorldTrace
        Recorded rows; ``trace["chaser"]`` contains the rows of a system of a world.
    summary : dict
        Content of ``summary.json``.
    scenario : Scenario or WorldScenario
        Scenario that was run.
    out : Path or None
        Output folder; None if the run had none.
    """

    trace: Trace | WorldTrace
    summary: dict[str, Any]
    scenario: Scenario | WorldScenario
    out: Path | None
    _ran: Model | dict[str, Model] | None = field(default=None, repr=False, compare=False)
    """Loaded robots; None after unpickling."""

    def __repr__(self) -> str:
        """Return a line with scenario, number of rows, status, verdict of the certificate and folder."""
        passed = self.summary.get("certificate_passed")
        verdict = "" if passed is None else f", certificate {'passed' if passed else 'failed'}"
        where = "" if self.out is None else f", in {self.out}"
        name, status = self.summary.get("scenario"), self.summary.get("status")
        return f"<Run {name!r}: {len(self.trace)} rows, {status}{verdict}{where}>"

    def _repr_html_(self) -> str | None:
        """Return a short report as HTML for notebooks."""
        from onorbit_rs.displays import or_plain, run_html

        return or_plain(run_html, self)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return the data to pickle, without the robot: a ``Pool`` hangs if unpickling raises an error."""
        return Run, (self.trace, self.summary, self.scenario, self.out)

    @cached_property
    def model(self) -> Model:
        """Robot of the run; after unpickling it is loaded from the scenario.

        Raises
        ------
        OnOrbitError
            If the robot's file is missing, cannot be read, or has changed since the run (``ModelError``).
        AttributeError
            If the scenario has several systems.
        """
        if isinstance(self.scenario, WorldScenario):
            names = ", ".join(f"models[{name!r}]" for name in self.scenario.systems)
            raise AttributeError(f"the scenario of the run has 'systems'; instead of 'model', use {names}")
        if self._ran is not None and not isinstance(self._ran, dict):
            return self._ran
        return _loaded(self.scenario, self.summary)

    @cached_property
    def models(self) -> dict[str, Model]:
        """Robots of a scenario with ``systems``, by the name of the system; see :attr:`model`.

        Raises
        ------
        OnOrbitError
            As for :attr:`model`.
        AttributeError
            If the scenario has a single robot.
        """
        if not isinstance(self.scenario, WorldScenario):
            raise AttributeError("the run has a single robot; use 'model' instead of 'models'")
        if isinstance(self._ran, dict):
            return self._ran
        systems = self.summary["systems"]
        found = {}
        for name, alone in self.scenario.scenarios.items():
            try:
                found[name] = _loaded(alone, systems[name])
            except ModelError as error:
                raise ModelError(f"system '{name}': {error}") from error
        return found


def _loaded(scenario: Scenario, summary: dict[str, Any]) -> Model:
    """Return the robot of a scenario; raise ModelError if it differs from that of the summary."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # these warnings were issued during the run
        model = scenario.robot.build(scenario)
    if was_changed(model, summary):
        raise ModelError(CHANGED)
    return model


def run(
    scenario: str | os.PathLike[str] | Mapping[str, Any] | Scenario | WorldScenario,
    out: str | os.PathLike[str] | None = None,
    *,
    force: bool = False,
    quiet: bool = False,
    view: bool = False,
    checkpoint_every: float = CHECKPOINT_EVERY,
    commands: str | os.PathLike[str] | Iterable[Mapping[str, Any]] | None = None,
    figures: bool = True,
    recording: bool = True,
    compress: bool = False,
    changes: Mapping[str, Any] | None = None,
) -> Run:
    """Run a scenario and, with ``out``, write its output folder.

    Parameters
    ----------
    scenario : str, path, mapping, Scenario or WorldScenario
        Name of a bundled scenario, a YAML file, its content as a mapping, or a loaded scenario.
    out : str or path, optional
        Folder for the results, such as trace, summary, figures and recording; None writes nothing.
    force : bool
        Replace the files of an earlier run in ``out``.
    quiet : bool
        Show no progress: no bar if stderr is a terminal, and otherwise no lines.
    view : bool
        Show the run in the viewer while it is simulated; without a display, a warning is issued.
    checkpoint_every : float
        Wall-clock time between two checkpoints in ``out``, s; :func:`resume` continues from the last one.
    commands : str, path or iterable of mapping, optional
        Commands to joints and bodies, and triggers of events, at given times: a file of
        :class:`CommandLog`, or its entries. They are checked before the run, and stored in ``out``.
    figures : bool
        Draw the figures in ``out``; ``onorbit report`` draws them later.
    recording : bool
        Write the recording for the viewer in ``out``.
    compress : bool
        Compress ``trace.npz``, to about 70 % of its size; :func:`numpy.load` and :func:`read_run` read
        it too.
    changes : mapping, optional
        New values of entries of the scenario, by path, such as ``{"simulation.duration": "2 s"}``.

    Returns
    -------
    Run

    Raises
    ------
    OnOrbitError
        Before the run starts: for an invalid scenario (``ScenarioError``), a missing file
        (``NotFoundError``), an invalid command or change (``InputError``, ``ControlError``, …), rows that
        need more memory than is available (``InputError``), or a folder that is not empty, not writable, in
        use by another process, or on a disk with too little space for the rows (``OutputFolderError``).
    SimulationError
        If the run diverges; the trace before the divergence is in the error and in ``out``.
    RunInterrupted
        On Ctrl-C; the trace before the interruption is in the exception and in ``out``.
    """
    every = _checked_period(checkpoint_every)
    checked = load(scenario, changes=changes)
    given = _given(commands)
    built = _with_warnings(_built(checked), given)
    check_commands(built.simulation, given, checked.simulation.duration)
    if out is None:
        return _simulate(built, None, quiet=quiet, view=view, commands=given)
    with OutputFolder.claim(out, force=force) as folder:
        write_scenario(folder, checked)
        if given:
            write_commands(folder, given)
        writer = CheckpointWriter(folder, _digest(checked))
        return _simulate(
            built, folder, Outputs(figures, recording, compress), quiet=quiet, view=view, commands=given,
            checkpoint=writer, checkpoint_every=every,
        )  # fmt: skip


def resume(
    out: str | os.PathLike[str],
    *,
    quiet: bool = False,
    view: bool = False,
    checkpoint_every: float = CHECKPOINT_EVERY,
    figures: bool = True,
    recording: bool = True,
    compress: bool = False,
) -> Run:
    """Resume an interrupted run with bit-identical results.

    Parameters
    ----------
    out : str or path
        Output folder with ``scenario.yaml`` and the last checkpoint.
    quiet : bool
        Show no progress: no bar if stderr is a terminal, and otherwise no lines.
    view : bool
        Show the run in the viewer, from its beginning.
    checkpoint_every : float
        Wall-clock time between two checkpoints, s.
    figures, recording, compress : bool
        As for :func:`run`.

    Returns
    -------
    Run

    Raises
    ------
    CheckpointError
        If there is no valid checkpoint, as after the end of the run, or if the scenario, its robot or the
        version of onorbit_rs has changed.
    OnOrbitError
        As for :func:`run`.
    """
    every = _checked_period(checkpoint_every)
    path = Path(out)
    check_folder(path)
    if not exists(path / "scenario.yaml"):
        raise NotFoundError(
            f"no run in this folder (scenario.yaml is missing): {path}; give the output folder of a run",
            path=str(path),
            kind="run",
        )
    with OutputFolder(path) as folder:
        folder.check_figures()
        scenario = load(path / "scenario.yaml")
        digest = _digest(scenario)
        saved = read_checkpoint(path, digest)
        writer = CheckpointWriter(folder, digest, after=saved)
        given, built = saved_commands(folder), _built(scenario)
        is_lazy = is_streamed(built, has_folder=True, is_viewed=view) and is_bounded(built, saved.checkpoint)
        checkpoint = saved.checkpoint if is_lazy else saved.in_memory()
        return _simulate(
            _with_warnings(built, given), folder, Outputs(figures, recording, compress), quiet=quiet,
            view=view, commands=given, checkpoint=writer, checkpoint_every=every, resume=checkpoint,
        )  # fmt: skip


def _built(scenario: Scenario | WorldScenario) -> Built | BuiltWorld:
    return build_world(scenario) if isinstance(scenario, WorldScenario) else build(scenario)


def _given(
    commands: str | os.PathLike[str] | Iterable[Mapping[str, Any]] | None,
) -> list[Command]:
    """Return the commands of a file or of entries, checked; empty for None."""
    if commands is None:
        return []
    if isinstance(commands, str | os.PathLike):
        return read_commands(commands)
    entries = enumerate(commands)
    return in_order(
        entry if isinstance(entry, Command) else checked_command(entry, f"commands[{index}]")
        for index, entry in entries
    )


def _with_warnings(built: Built | BuiltWorld, commands: list[Command]) -> Built | BuiltWorld:
    """Warn of controllers that follow commands in a run without commands; return the run with warnings."""
    messages = tuple(warnings_without(built.scenario)) if not commands else ()
    for message in messages:
        warn_user(message)
    return replace(built, warnings=(*built.warnings, *messages)) if messages else built


def _checked_period(checkpoint_every: float) -> float:
    """Return the checkpoint period, s; raise InputError if it is invalid, before any file is written."""
    every = finite_float(checkpoint_every)
    if every is None or every < 0.0:
        raise InputError(
            f"checkpoint_every is {checkpoint_every!r}; it must be a finite number of seconds, at least 0",
            name="checkpoint_every", got=checkpoint_every, expected=">= 0",
        )  # fmt: skip
    return every


def _digest(scenario: Scenario | WorldScenario) -> str:
    """Return the digest of a scenario, of the files that it refers to, and of the engine's version."""
    return scenario_digest(with_absolute_paths(scenario) | versions(scenario.engine))


def _simulate(
    built: Built | BuiltWorld,
    folder: OutputFolder | None,
    outputs: Outputs = ALL,
    *,
    quiet: bool,
    view: bool = False,
    commands: Sequence[Command] = (),
    **checkpoints: Any,
) -> Run:
    """Simulate and write the results, including those of a run that was stopped or failed."""
    scenario, duration = built.scenario, built.scenario.simulation.duration
    check_size(built, folder.path if folder else None, is_viewed=view, compress=outputs.compress)
    try:
        with progress_bar(scenario.name, duration, quiet=quiet) as progress:
            trace: Trace | WorldTrace
            if is_streamed(built, has_folder=folder is not None, is_viewed=view):
                found = streamed(built, progress.move, **checkpoints, commands=commands)
                trace = cast("Trace | WorldTrace", found)
            elif view or commands:
                trace = watched(built, progress.move, **checkpoints, view=view, commands=commands)
            else:
                trace = built.simulation.run(duration, progress=progress.move, **checkpoints)
            summary = finished(trace, built, folder, progress.tell, outputs)
            return Run(trace, summary, scenario, folder.path if folder else None, _models(built))
    except (SimulationError, RunInterrupted) as stop:
        with doing("stopped; writing the results so far", quiet=quiet) as tell:
            keep_stopped(stop, built, folder, tell, outputs)
        raise
    except (
        Exception
    ) as error:  # raised by a Python controller, or outside of the validity of the orbit or environment
        keep_failed(error, built, folder, outputs)
        raise


def _models(built: Built | BuiltWorld) -> Model | dict[str, Model]:
    """Return the robot of a run, or the robots of its systems by name."""
    if isinstance(built, Built):
        return built.model
    return {name: system.model for name, system in built.systems.items()}
