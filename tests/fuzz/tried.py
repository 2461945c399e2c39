"""Tries one input: it is parsed, rejected with a typed error, or kept on disk as a finding."""

from __future__ import annotations

import contextlib
import hashlib
import io
import random
import traceback
import warnings
from collections.abc import Iterable
from pathlib import Path

from targets import TARGETS, Room

from onorbit_rs.exceptions import OnOrbitError


class Trial:
    """A target and its findings: one file for each failing place."""

    def __init__(self, name: str, findings: Path, seed: int) -> None:
        self.name, self.target, self.seed = name, TARGETS[name], seed
        self.room, self.findings = Room(), findings
        self.places: set[str] = set()

    def __call__(self, data: bytes) -> None:
        """Tries an input."""
        try:
            with warnings.catch_warnings(), contextlib.redirect_stderr(io.StringIO()):
                warnings.simplefilter("ignore")
                self.target(data, self.room)
        except OnOrbitError as error:
            if not str(error).strip():
                self._keep(data, error)
        except Exception as error:
            self._keep(data, error)
        except BaseException as error:  # pyo3's PanicException does not derive from Exception
            self._keep(data, error)
            if isinstance(error, (KeyboardInterrupt, SystemExit)):
                raise

    def _keep(self, data: bytes, error: BaseException) -> None:
        frame = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{type(error).__name__} {Path(frame.filename).name}:{frame.lineno}"
        if place in self.places:
            return
        self.places.add(place)
        self.findings.mkdir(parents=True, exist_ok=True)
        file = self.findings / f"{self.name}-{hashlib.sha256(data).hexdigest()[:16]}"
        file.write_bytes(data)
        traceback_text = "".join(traceback.format_exception(error))
        file.with_suffix(".txt").write_text(
            f"target {self.name}\nseed {self.seed}\n{traceback_text}", encoding="utf-8"
        )


def mutated(draw: random.Random, parent: bytes, other: bytes) -> bytes:
    """Returns a mutation of `parent`, sometimes crossed with `other`."""
    data = bytearray(parent)
    for _ in range(draw.choice((1, 1, 2, 4, 8))):
        at = draw.randrange(len(data) + 1)
        end = min(len(data), at + draw.randrange(9))
        match draw.randrange(6):
            case 0 if at < len(data):
                data[at] ^= 1 << draw.randrange(8)
            case 1:
                del data[at:end]
            case 2:
                data[at:at] = data[at:end]
            case 3:
                data[at:end] = draw.choice(
                    (b"nan", b"1e308", b"-1", b"0", b"[", b"{", b"\0", b"", b"<a>", b"9" * 30)
                )
            case 4 if other:
                start = draw.randrange(len(other))
                data[at:end] = other[start : start + draw.randrange(40)]
            case _:
                data.insert(at, draw.randrange(256))
    return bytes(data[:16_384])


def blind(trial: Trial, corpus: Iterable[bytes], count: int) -> int:
    """Tries the corpus and its mutations without coverage; returns the number of inputs."""
    inputs, draw = list(corpus), random.Random(trial.seed)
    for data in inputs:
        trial(data)
    for _ in range(count):
        trial(mutated(draw, draw.choice(inputs), draw.choice(inputs)))
    return len(inputs) + count
