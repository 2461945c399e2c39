"""What a published case is, and what becomes of it."""

from __future__ import annotations

import csv
import importlib.util
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from onorbit_rs.printable import json_value

INSTALL = {
    "pinocchio": "pip install pin", "mujoco": "pip install mujoco-core", "SPARTpy": "pip install spartpy",
}  # fmt: skip
"""Commands that install the engines some cases compare with; the package needs none of them."""


class CannotRunError(Exception):
    """What a case needs does not work here, which says nothing about us."""


@dataclass(frozen=True)
class Gate:
    """The error of ``quantity`` may be ``limit``, in ``unit`` (empty for a share or a count)."""

    quantity: str
    limit: float
    unit: str = ""

    def __str__(self) -> str:
        """``≤ 0.1 m``."""
        return f"≤ {self.limit:.3g} {self.unit}".rstrip()


@dataclass(frozen=True)
class Check:
    """One error against its gate; both are None where the case was skipped, the error where it broke."""

    quantity: str
    unit: str
    error: float | None
    gate: float
    passed: bool | None

    @property
    def share(self) -> float:
        """Of the gate that the error takes."""
        if self.error is None or self.error != self.error:
            return float("inf")
        return 0.0 if self.error == 0.0 else self.error / self.gate if self.gate else float("inf")

    def as_dict(self) -> dict[str, Any]:
        """For JSON, which has no NaN."""
        return asdict(self) | {"error": json_value(self.error)}


@dataclass(frozen=True)
class Verdict:
    """What became of a case: ``passed`` is None where it was skipped, and ``note`` says why."""

    family: str
    case: str
    source: str
    passed: bool | None
    checks: tuple[Check, ...]
    note: str = ""

    @property
    def nearest(self) -> Check:
        """The check that comes nearest to its gate, or is furthest beyond it."""
        return max(self.checks, key=lambda check: check.share)

    def as_dict(self) -> dict[str, Any]:
        """For JSON: the nearest check beside the case's name and source, then all of them."""
        head = {"family": self.family, "case": self.case, "source": self.source}
        checks = [check.as_dict() for check in self.checks]
        tail = {"passed": self.passed, "note": self.note, "checks": checks}
        return head | self.nearest.as_dict() | tail


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

    def judge(self) -> Verdict:
        """Run it; what raises has failed, and what cannot be run has neither passed nor failed."""
        if self.needs and importlib.util.find_spec(self.needs) is None:
            return self._without_errors(None, f"{self.needs} is not installed: {INSTALL[self.needs]}")
        try:
            errors = [float(error) for error in self.measure()]
            pairs = list(zip(self.gates, errors, strict=True))
        except CannotRunError as reason:
            return self._without_errors(None, str(reason))
        except Exception as error:  # whatever it is, the others run on
            return self._without_errors(False, f"{type(error).__name__}: {error}")
        # a NaN is within no gate
        checks = [
            Check(gate.quantity, gate.unit, error, gate.limit, error <= gate.limit) for gate, error in pairs
        ]
        passed = all(check.passed for check in checks)
        return Verdict(self.family, self.name, self.source, passed, tuple(checks))

    def not_run(self) -> Verdict:
        """Its gates alone."""
        return self._without_errors(None, "")

    def _without_errors(self, passed: bool | None, note: str) -> Verdict:
        checks = [Check(gate.quantity, gate.unit, None, gate.limit, passed) for gate in self.gates]
        return Verdict(self.family, self.name, self.source, passed, tuple(checks), note)


def worst(errors: Iterable[Any]) -> Any:
    """Largest of some errors, or of each column of rows of them; a NaN among them is the largest.

    Raises
    ------
    ValueError
        There is none: what was compared with nothing agrees with anything.
    """
    found = np.array(list(errors), dtype=np.float64)
    if not found.size:
        raise ValueError("there was nothing to compare")
    return found.max(axis=0)  # Python's max(0.0, nan) is 0.0


def table(name: str) -> list[dict[str, str]]:
    """Rows of one of the tables beside this file."""
    with (Path(__file__).parent / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))
