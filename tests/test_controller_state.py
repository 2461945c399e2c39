"""Checkpoints store plain data of Python controllers without loss, and never code."""

from __future__ import annotations

import json
import math
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import CheckpointError, ControlError, RunInterrupted
from onorbit_rs.simulation.controller_state import decode, encode

VALUES: dict[str, Any] = {
    "none": None,
    "numbers": [True, 0, -(2**80), 0.1, -0.0, 5e-324, 1.7976931348623157e308, 2.5j],
    "text": "Grüße\ud800\n",
    "nested": {"a": (1, [2.0, {"b": ()}]), 3: [], (1, "x"): {}, None: {True: 1.5}},
    "scalars": [np.float64(0.1), np.float32(0.1), np.int8(-3), np.bool_(True), np.complex128(1 - 2j)],
}
ARRAYS = [
    np.array([[0.1, np.nan], [-np.inf, -0.0]]),
    np.array([np.nan]).view(np.uint64) + np.uint64(77),
    np.asfortranarray(np.arange(12.0).reshape(3, 4)),
    np.arange(24, dtype=np.int16).reshape(2, 3, 4)[:, ::2],
    np.array(3 + 4j, dtype=np.complex64),
    np.zeros((0, 7)),
    np.arange(3, dtype=">f4"),
    np.array([True, False]),
]


@pytest.mark.parametrize("name", VALUES)
def test_plain_data_is_restored_unchanged(name: str) -> None:
    again = decode(encode(VALUES[name]))
    assert again == VALUES[name]
    assert repr(again) == repr(VALUES[name])  # types and signs of zero too


@pytest.mark.parametrize("index", range(len(ARRAYS)))
def test_arrays_are_restored_bit_by_bit_and_writable(index: int) -> None:
    array = ARRAYS[index]
    again = decode(encode({"x": array}))["x"]
    assert (again.dtype, again.shape) == (array.dtype, array.shape)
    assert again.tobytes() == array.tobytes()
    assert again.flags.f_contiguous or not array.flags.f_contiguous
    assert again.flags.writeable


def test_non_finite_values_are_kept() -> None:
    inf, minus, nan = decode(encode([math.inf, -math.inf, math.nan]))
    assert (inf, minus) == (math.inf, -math.inf)
    assert math.isnan(nan)


def test_one_object_under_two_names_remains_one() -> None:
    shared = np.zeros(3)
    history: list[Any] = [shared]
    history.append(history)
    again = decode(encode({"now": shared, "history": history, "copy": np.zeros(3)}))
    assert again["history"][0] is again["now"]
    assert again["history"][1] is again["history"]
    assert again["copy"] is not again["now"]


class Number(float):
    """A subclass of float with additional state."""


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (object(), "object"),
        (b"\x80\x04", "bytes"),
        ({1, 2}, "set"),
        (Number(1.0), "Number"),
        (Path("x"), "Path"),
        (np.array([object()]), "dtype object"),
        (np.zeros(2, dtype=[("a", "f8")]), "dtype"),
        (np.array(["text"]), "dtype <U4"),
        (np.ma.zeros(3), "MaskedArray"),
        (np.random.default_rng(1), "Generator"),
        (lambda: 0, "function"),
    ],
)
def test_other_values_are_rejected_with_their_type_and_place(value: object, kind: str) -> None:
    with pytest.raises(ControlError) as caught:
        encode({"gains": [1.0, value]})
    assert kind in str(caught.value)
    assert "state['gains'][1]" in str(caught.value)
    assert caught.value.expected in str(caught.value)
    with pytest.raises(ControlError, match="a key of state"):
        encode({frozenset(): 1})


def test_state_nested_too_deeply_is_rejected() -> None:
    deep: list[Any] = []
    for _ in range(100_000):
        deep = [deep]
    with pytest.raises(ControlError, match="nested too deep") as caught:
        encode(deep)
    assert caught.value.__context__ is None, "programs that pickle the context could not pickle its traceback"


def state_text(state: Any) -> bytes:
    return json.dumps({"format": "onorbit_rs controller state 1", "state": state}).encode()


@pytest.mark.parametrize(
    "text",
    [
        b"", b"\xff", b"null", b"[]", b'{"format": 2}', b"[" * 100_000, b"9" * 5000,
        state_text({"array": {"dtype": "|O", "shape": [1], "order": "C", "data": "AAAAAAAAAAA="}}),
        state_text({"array": {"dtype": "f8,O", "shape": [1], "order": "C", "data": ""}}),
        state_text({"array": {"dtype": "<f8", "shape": [10**12], "order": "C", "data": ""}}),
        state_text({"array": {"dtype": "<f8", "shape": [-1], "order": "C", "data": "AAAAAAAAAAA="}}),
        state_text({"array": {"dtype": "<f8", "shape": [1], "order": "C", "data": "not base64"}}),
        state_text({"array": {"dtype": "<f8", "shape": [1], "order": "X", "data": "AAAAAAAAAAA="}}),
        state_text({"array": 1}), state_text({"again": 3}), state_text({"a": 1, "b": 2}),
        state_text({"eval": "1"}),
        state_text({"dict": [[[], 1]]}), state_text({"dict": 7}), state_text({"float": "x"}),
    ],
)  # fmt: skip
def test_a_damaged_state_is_rejected(text: bytes) -> None:
    with pytest.raises(CheckpointError, match=r"is invalid.*run the scenario again"):
        decode(text)


class Payload:
    """Creates a file when it is unpickled."""

    def __init__(self, file: Path) -> None:
        self.file = file

    def __reduce__(self) -> tuple[Any, ...]:
        return Path.touch, (self.file,)


class Integral(oo.Controller):
    def __init__(self, model: oo.Model) -> None:
        self.model = model  # is created again by the constructor
        self.sum, self.calls = np.zeros(7), 0

    def reset(self) -> None:
        self.sum, self.calls = np.zeros(7), 0

    def update(self, t: float, state: Any) -> np.ndarray:
        self.calls += 1
        self.sum += 1e-3 * state.v[6:]
        return -0.02 * state.v[6:] - 0.01 * self.sum


def stopped(controller: oo.Controller) -> tuple[oo.Simulation, list[oo.Checkpoint]]:
    """Returns a simulation whose run Ctrl-C ended after its first checkpoint, and its checkpoints."""
    model = oo.robots.load("humanoid_torso")
    v = np.full(model.nv, 0.02)
    simulation = oo.Simulation(model, model.neutral(), v, time_step=1e-3, controller=controller)
    kept: list[oo.Checkpoint] = []

    def stop(t: float, duration: float) -> None:
        if kept:
            raise KeyboardInterrupt

    with pytest.raises(RunInterrupted):
        simulation.run(30.0, progress=stop, checkpoint=kept.append, checkpoint_every=0.0)
    return simulation, kept


def put_together(kept: list[oo.Checkpoint], state: str) -> oo.Checkpoint:
    columns = {name: np.concatenate([part.columns[name] for part in kept]) for name in kept[0].columns}
    return oo.Checkpoint(state, columns)


def test_a_python_controller_continues_to_the_same_bits() -> None:
    simulation, kept = stopped(Integral(oo.robots.load("humanoid_torso")))
    rest = simulation.run(30.0, resume=put_together(kept, kept[-1].state))
    whole = simulation.run(30.0)
    assert rest.q.tobytes() == whole.q.tobytes()
    forgetful = json.loads(kept[-1].state)  # negative control: the controller's state matters
    forgetful["groups"][0]["controllers"]["systems"][0]["controls"][0]["user"] = list(
        encode({"sum": np.ones(7), "calls": 0})
    )
    other = simulation.run(30.0, resume=put_together(kept, json.dumps(forgetful)))
    assert other.q.tobytes() != whole.q.tobytes()


def test_a_checkpoint_with_a_pickle_runs_no_code(tmp_path: Path) -> None:
    file = tmp_path / "it_ran"
    evil = pickle.dumps(Payload(file))
    simulation, kept = stopped(Integral(oo.robots.load("humanoid_torso")))
    record = json.loads(kept[-1].state)
    record["groups"][0]["controllers"]["systems"][0]["controls"][0]["user"] = list(evil)
    with pytest.raises(CheckpointError, match=r"pickle.*not read; run the scenario again"):
        simulation.run(30.0, resume=put_together(kept, json.dumps(record)))
    assert not file.exists()
    pickle.loads(evil)  # negative control: the payload works
    assert file.exists()


def test_a_controller_with_other_state_causes_a_warning_and_continues() -> None:
    class Odd(Integral):
        def get_state(self) -> Any:
            return {"file": Path("x")}

    model = oo.robots.load("humanoid_torso")
    simulation = oo.Simulation(model, model.neutral(), np.zeros(model.nv), controller=Odd(model))
    with pytest.warns(
        UserWarning, match=r"checkpoints are disabled.*state\['file'\] is of type pathlib.*numeric NumPy"
    ):
        assert simulation.run(10.0, checkpoint=lambda _: None, checkpoint_every=0.0).time[-1] == 10.0


BETWEEN_PROCESSES = {
    f"common/processes.py: {line}"
    for line in ("import pickle", "return pickle.loads(content)", "return pickle.load(stream)")
}
"""Lines that exchange pickled objects with processes that this process has started."""


def test_the_package_never_unpickles_or_evaluates_text() -> None:
    """Processes of the package may pickle data for each other; reading a file never unpickles."""
    package = Path(oo.__file__).parent
    banned = re.compile(r"\bpickle\.load|import pickle|allow_pickle=True|unsafe_load|(?<![\w.])(eval|exec)\(")
    found = [
        f"{file.relative_to(package).as_posix()}: {line.strip()}"
        for file in package.rglob("*.py")
        for line in file.read_text(encoding="utf-8").splitlines()
        if banned.search(line)
    ]
    assert sorted(found) == sorted(BETWEEN_PROCESSES)
    assert banned.search("self = pickle.loads(text)") and banned.search("x = eval(text)")  # control
