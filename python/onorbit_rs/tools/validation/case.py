"""A validation case, its gates and its verdict."""

from __future__ import annotations

import csv
import importlib.util
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from onorbit_rs.common.printable import json_value

INSTALL = {
    "pinocchio": "pip install pin", "mujoco": "pip install mujoco-core", "SPARTpy": "pip install spartpy",
}  # fmt: skip
"""Commands that install the optional engines with which some cases compare."""


class CannotRunError(Exception):
    """Raised if an engine required by a case does not work on this machine; the case is then skipped."""


@dataclass(frozen=True)
class Gate:
    """Largest error allowed in ``quantity``, in ``unit`` (empty for a relative error or a count)."""

    quantity: str
    limit: float
    unit: str = ""

    def __str__(self) -> str:
        """Return the limit as text, such as ``≤ 0.1 m``."""
        return f"≤ {self.limit:.3g} {self.unit}".rstrip()


@dataclass(frozen=True)
class Check:
    """Comparison of one error of a case with its gate.

    A skipped case has None for ``passed`` and ``error``. If the case raised an error, ``passed`` is False and
    ``error`` is None.
    """

    quantity: str
    unit: str
    error: float | None
    gate: float
    passed: bool | None

    @property
    def ratio(self) -> float:
        """Error divided by the gate; infinite if the error is missing or NaN, or above a gate of zero."""
        if self.error is None or self.error != self.error:
            return float("inf")
        return 0.0 if self.error == 0.0 else self.error / self.gate if self.gate else float("inf")

    def as_dict(self) -> dict[str, Any]:
        """Return the check as plain data for JSON, without NaN."""
        return asdict(self) | {"error": json_value(self.error)}


@dataclass(frozen=True)
class Verdict:
    """Result of a case; ``passed`` is None if it was skipped, and ``note`` explains a skip or an error."""

    family: str
    case: str
    source: str
    passed: bool | None
    checks: tuple[Check, ...]
    note: str = ""

    @property
    def nearest(self) -> Check:
        """The check with the largest ratio of error to gate."""
        return max(self.checks, key=lambda check: check.ratio)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON: name, source, the check nearest to its gate, then all checks."""
        head = {"family": self.family, "case": self.case, "source": self.source}
        checks = [check.as_dict() for check in self.checks]
        tail = {"passed": self.passed, "note": self.note, "checks": checks}
        return head | self.nearest.as_dict() | tail


@dataclass(frozen=True)
class Case:
    """A published result or a conservation law, and the largest errors allowed in its reproduction.

    ``measure`` runs the case through the public API and returns one error per gate. If the module
    ``needs`` is not installed, the case is skipped.
    """

    family: str
    name: str
    source: str
    gates: tuple[Gate, ...]
    measure: Callable[[], Sequence[float]]
    needs: str = ""

    def judge(self) -> Verdict:
        """Run the case and return its verdict: an error means failed; a case that cannot run is skipped."""
        if self.needs and importlib.util.find_spec(self.needs) is None:
            return self._without_errors(None, f"{self.needs} is not installed: {INSTALL[self.needs]}")
        try:
            errors = [float(error) for error in self.measure()]
            pairs = list(zip(self.gates, errors, strict=True))
        except CannotRunError as reason:
            return self._without_errors(None, str(reason))
        except Exception as error:  # an error of one case does not stop the others
            return self._without_errors(False, f"{type(error).__name__}: {error}")
        # NaN <= limit is false
        checks = [
            Check(gate.quantity, gate.unit, error, gate.limit, error <= gate.limit) for gate, error in pairs
        ]
        passed = all(check.passed for check in checks)
        return Verdict(self.family, self.name, self.source, passed, tuple(checks))

    def not_run(self) -> Verdict:
        """Return a verdict with the gates of the case and without errors; the case is not run."""
        return self._without_errors(None, "")

    def _without_errors(self, passed: bool | None, note: str) -> Verdict:
        checks = [Check(gate.quantity, gate.unit, None, gate.limit, passed) for gate in self.gates]
        return Verdict(self.family, self.name, self.source, passed, tuple(checks), note)


def worst(errors: Iterable[Any]) -> Any:
    """Return the largest error, or the largest of each column of rows of errors; NaN counts as largest.

    Raises
    ------
    ValueError
        If ``errors`` is empty, because an empty comparison must not pass.
    """
    found = np.array(list(errors), dtype=np.float64)
    if not found.size:
        raise ValueError("the case returned no errors to compare")
    return found.max(axis=0)  # unlike Python's max, this keeps NaN


def table(name: str) -> list[dict[str, str]]:
    """Return the rows of a CSV table in this folder."""
    with (Path(__file__).parent / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))
