"""A run read from its folder, with its columns as tables."""

from __future__ import annotations

import os
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from onorbit_rs.exceptions import InputError, OnOrbitError
from onorbit_rs.output.read import SavedRun
from onorbit_rs.output.saved_world import system_in, systems_in
from onorbit_rs.scenario.environment.earth import build_earth
from onorbit_rs.tables.extra import required
from onorbit_rs.tables.labels import Label, Names, flat, labels
from onorbit_rs.visuals.earth_shape import is_earth

if TYPE_CHECKING:
    from onorbit_rs._core import Model


class RecordedRun:
    """Summary and columns of a run in a folder.

    Attributes
    ----------
    folder : Path
        Output folder of the run.
    summary : dict
        Content of ``summary.json``.
    systems : list of str
        Names of the systems; empty for a run of one robot.
    """

    def __init__(self, folder: Path) -> None:
        """Read summary and columns; the errors are those of :func:`read_run`."""
        self.folder = folder
        self._saved = SavedRun(folder)
        self.summary = self._saved.summary()
        self._arrays, self._names = self._saved.columns()
        self.systems = systems_in(self._arrays) if "systems" in self.summary else []

    def __repr__(self) -> str:
        """Return a short text with the folder, the number of rows, the systems and the status."""
        whose = f" of {', '.join(self.systems)}" if self.systems else ""
        number = len(self._arrays["time"])
        rows = f"{number} row{'' if number == 1 else 's'}"
        return f"<RecordedRun: {self.folder}, {rows}{whose}, {self.summary.get('status')}>"

    def columns(self, system: str | None = None) -> dict[str, Any]:
        """Return the columns of the robot or of one system, by path.

        Parameters
        ----------
        system : str, optional
            Name of the system; required if the run has several systems.

        Returns
        -------
        dict of str to array
            Columns (T, ...) as in ``trace.npz``, in SI units.

        Raises
        ------
        InputError
            If the run has several systems and ``system`` is None, or if it has no such system.
        """
        if not self.systems and system is None:
            return dict(self._arrays)
        return dict(system_in(self._arrays, self._checked(system)).arrays)

    def table(self, system: str | None = None) -> tuple[list[Label], Any]:
        """Return the labels of the numbers in a row, and the rows, (T, n); the first number is the time, s.

        Parameters
        ----------
        system : str, optional
            Name of the system; required if the run has several systems.

        Returns
        -------
        labels : list of Label
            Name and unit of each number in a row.
        rows : (T, n) array
            Values, in SI units.

        Raises
        ------
        InputError
            As for :meth:`columns`.
        """
        columns = self.columns(system)
        names, count = self._names_of(system), len(columns["time"])
        rows = {path: values for path, values in columns.items() if len(values) == count}
        rows = {"time": rows.pop("time"), **rows}
        found = [label for path, values in rows.items() for label in labels(path, values.shape[1:], names)]
        return found, np.hstack([flat(values) for values in rows.values()])

    def to_pandas(self, system: str | None = None) -> Any:
        """Return the rows as a ``pandas.DataFrame`` with the time as its index.

        The columns have names such as ``q/position/x`` and ``tau/elbow``; ``frame.attrs["units"]`` has their
        units, and ``frame.attrs["summary"]`` is the summary of the run.

        Parameters
        ----------
        system : str, optional
            Name of the system; required if the run has several systems.

        Returns
        -------
        pandas.DataFrame
            Rows of the trace, in SI units.

        Raises
        ------
        NotFoundError
            If pandas is not installed.
        InputError
            As for :meth:`columns`.
        """
        pandas = required("pandas", "to_pandas")
        found, rows = self.table(system)
        index = pandas.Index(rows[:, 0], name="time")
        frame = pandas.DataFrame(rows[:, 1:], index=index, columns=[label.name for label in found[1:]])
        frame.attrs["units"] = {label.name: label.unit for label in found}
        frame.attrs["summary"] = self.summary
        return frame

    def to_xarray(self, system: str | None = None) -> Any:
        """Return the rows as an ``xarray.Dataset`` with the time as a coordinate.

        Each variable is one number per row, as in :meth:`to_pandas`, with its unit in ``attrs["units"]``.

        Parameters
        ----------
        system : str, optional
            Name of the system; required if the run has several systems.

        Returns
        -------
        xarray.Dataset
            Variables over ``time``, in SI units.

        Raises
        ------
        NotFoundError
            If xarray is not installed.
        InputError
            As for :meth:`columns`.
        """
        xarray = required("xarray", "to_xarray")
        found, rows = self.table(system)
        variables = {
            label.name: ("time", rows[:, number], {"units": label.unit})
            for number, label in enumerate(found)
            if number
        }
        time = ("time", rows[:, 0], {"units": "s"})
        name = str(self.summary.get("scenario", ""))
        return xarray.Dataset(variables, coords={"time": time}, attrs={"scenario": name})

    @cached_property
    def epoch(self) -> str | None:
        """Epoch with its time scale, such as ``2024-03-01T12:00:00.000000 UTC``; None without an epoch."""
        scenario = self._saved.scenario()
        orbit = None if scenario.orbit is None else scenario.orbit.build(self.folder)
        earth = build_earth(scenario.earth, scenario.epoch, orbit, self.folder)
        return None if earth is None else earth.epoch

    @property
    def parts(self) -> list[dict[str, Any]]:
        """Summaries of the systems; a run of one robot has a single one."""
        return list(self.summary["systems"].values()) if self.systems else [self.summary]

    @cached_property
    def is_about_earth(self) -> bool:
        """True unless the reference orbit is around a planet other than the Earth."""
        orbit = self._saved.scenario().orbit
        mu = None if orbit is None else orbit.build(self.folder).mu
        return mu is None or is_earth(mu)

    @cached_property
    def _models(self) -> dict[str, Model]:
        """Robots by system, or under an empty name; empty if they can no longer be read."""
        scenario = self._saved.scenario()
        alone = getattr(scenario, "scenarios", None) or {"": scenario}
        try:
            return {name: one.robot.build(one) for name, one in alone.items()}
        except OnOrbitError:
            return {}

    def _names_of(self, system: str | None) -> Names:
        prefix = f"{system}/" if system else ""
        joints = self._names.get(f"{prefix}joint_names", [])
        model = self._models.get(system or "")
        units = [] if model is None else Names.of(model).joint_units
        return Names(joints, self._names.get(f"{prefix}body_names", []), units)

    def _checked(self, system: str | None) -> str:
        if not self.systems:
            raise InputError(
                f"the run has a single robot, so there is no system {system!r}; omit system",
                name="system",
                got=system,
                expected=[],
            )
        if system not in self.systems:
            known = ", ".join(self.systems)
            what = "no system is given" if system is None else f"there is no system {system!r}"
            raise InputError(
                f"{what}; give one of the systems of the run: {known}",
                name="system",
                got=system,
                expected=self.systems,
            )
        return str(system)


def read_run(folder: str | os.PathLike[str]) -> RecordedRun:
    """Read a run from its output folder.

    Parameters
    ----------
    folder : str or path
        The ``out`` folder of :func:`onorbit_rs.run`.

    Returns
    -------
    RecordedRun
        With the methods ``to_pandas`` and ``to_xarray``.

    Raises
    ------
    NotFoundError
        If there is no run in the folder.
    IntegrityError, ReadError
        If its files were changed after the run, or cannot be read.
    """
    return RecordedRun(Path(folder))
