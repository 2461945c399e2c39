"""What a published case is, and what becomes of it."""

from __future__ import annotations

import csv
import importlib.util
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from onorbit_rs.exceptions import OnOrbitError

INSTALL = {"pinocchio": "pip install pin", "mujoco": "pip install mujoco", "sgp4": "pip install sgp4"}
"""How to get the engines that some cases ask; none is needed to use the package."""


@dataclass(frozen=True)
class Gate:
    """The error of ``quantity`` may be ``limit``, in ``unit`` (``"1"``: a share)."""

    quantity: str
    limit: float
    unit: str


@dataclass(frozen=True)
class Case:
    """Something that others have published, or that must be so, and how far off we may be.

    ``measure`` runs it through the public API and returns one error for each of ``gates``.
    ``needs`` is the engine without which it is skipped.
    """

    family: str
    name: str
    source: str
    gates: tuple[Gate, ...]
    measure: Callable[[], Sequence[float]]
    needs: str = ""

    def verdicts(self) -> list[Verdict]:
        """Run it; what raises has failed, and what cannot be run is neither passed nor failed."""
        if self.needs and importlib.util.find_spec(self.needs) is None:
            return self._without_error(None, f"{self.needs} is not installed: {INSTALL[self.needs]}")
        try:
            errors = [float(error) for error in self.measure()]
            if len(errors) != len(self.gates):
                raise ValueError(f"{len(errors)} errors for {len(self.gates)} gates")
        except (OnOrbitError, ArithmeticError, ImportError, LookupError, ValueError) as error:
            return self._without_error(False, f"{type(error).__name__}: {error}")
        pairs = zip(self.gates, errors, strict=True)
        # a NaN is not within any gate
        return [Verdict.of(self, gate, error, error <= gate.limit) for gate, error in pairs]

    def _without_error(self, passed: bool | None, note: str) -> list[Verdict]:
        return [Verdict.of(self, gate, None, passed, note) for gate in self.gates]


@dataclass(frozen=True)
class Verdict:
    """One line of the table: ``error`` against ``gate``. ``passed`` is None where the case was skipped."""

    family: str
    case: str
    source: str
    quantity: str
    unit: str
    error: float | None
    gate: float
    passed: bool | None
    note: str

    @staticmethod
    def of(case: Case, gate: Gate, error: float | None, passed: bool | None, note: str = "") -> Verdict:
        """With what the case and its gate say."""
        return Verdict(
            case.family, case.name, case.source, gate.quantity, gate.unit, error, gate.limit, passed, note
        )

    def plain(self) -> dict[str, Any]:
        """For JSON, which has no NaN."""
        data = asdict(self)
        is_number = self.error is not None and abs(self.error) < float("inf")
        return data | {"error": self.error if is_number else None}


def table(name: str) -> list[dict[str, str]]:
    """Rows of one of the tables beside this file."""
    with (Path(__file__).parent / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))
