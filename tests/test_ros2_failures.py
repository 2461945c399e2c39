"""A start or an end that fails: typed errors, no open ports, and files that are unchanged or complete."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest
from ros2_runs import DOMAIN, Peer, needs_ros2, node_of
from stepper_runs import passive, scenario

from onorbit_rs.exceptions import DtypeError, InputError, OutputFolderError, Ros2Error

needs_ros2()

from cyclonedds.core import DDSException  # noqa: E402

from onorbit_rs.ros2 import Node, graph, loopback, node, participant  # noqa: E402

WRENCH = ("/wrench_command", "geometry_msgs/msg/WrenchStamped", {"wrench": {"force": {"x": 1.0}}})
full = pytest.mark.skipif(
    not Path("/dev/full").exists(), reason="the test writes to /dev/full, which does not exist here"
)


def failing(error: BaseException, after: int, real: Any) -> Any:
    """Returns a function that raises an error when it has been called ``after`` times."""
    calls = iter(range(1000))

    def call(*values: Any, **options: Any) -> Any:
        if next(calls) >= after:
            raise error
        return real(*values, **options)

    return call


NO_ROOM = DDSException(DDSException.DDS_RETCODE_OUT_OF_RESOURCES)
STARTS = [
    (participant, "BuiltinDataReader", 0, r"cannot join DDS domain \d+ .*use another domain"),
    (participant, "DataWriter", 0, r"cannot join DDS domain \d+ .*use another domain"),
    (participant, "DataWriter", 1, "cannot publish /clock .*close other nodes"),
    (participant, "DataWriter", 6, "cannot publish /"),
    (participant, "DataReader", 0, "cannot subscribe to /pause .*close other nodes"),
    (participant, "DataReader", 3, "cannot subscribe to /trigger "),
    (participant, "Topic", 3, "cannot publish /"),
    (graph, "_gid", 0, "cannot announce the node onorbit .*close other nodes"),
]


@pytest.mark.parametrize(("module", "name", "after", "message"), STARTS)
def test_a_start_that_fails_leaves_nothing_open_and_the_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: Any, name: str, after: int, message: str
) -> None:
    log, record = tmp_path / "commands.jsonl", tmp_path / "run.mcap"
    for file in (log, record):
        file.write_text("precious")
    before = set(loopback.udp_sockets())
    with monkeypatch.context() as patch:
        patch.setattr(module, name, failing(NO_ROOM, after, getattr(module, name)))
        with pytest.raises(Ros2Error, match=message) as found:
            Node(scenario(), domain=DOMAIN, log=log, record=record)
    assert "lack of resources" in str(found.value) and found.value.reason in str(found.value)
    assert isinstance(found.value.__cause__, DDSException)
    assert set(loopback.udp_sockets()) == before, "while the error is still there"
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {
        "commands.jsonl": "precious", "run.mcap": "precious",
    }  # fmt: skip
    Node(scenario(), domain=DOMAIN, log=log, record=record).close()
    assert log.read_text() == "", "a start that succeeds replaces them"
    assert record.read_bytes().startswith(b"\x89MCAP")


@pytest.mark.parametrize("error", [KeyboardInterrupt(), OutputFolderError("full")])
def test_an_interrupted_start_leaves_nothing_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException
) -> None:
    monkeypatch.setattr(node, "CommandLog", failing(error, 0, None))
    with pytest.raises(type(error)):
        Node(scenario(), domain=DOMAIN, record=tmp_path / "run.mcap")
    assert not list(loopback.udp_sockets()) and not list(tmp_path.iterdir())


def test_arguments_that_are_wrong_are_refused_before_anything_is_opened(tmp_path: Path) -> None:
    same: dict[str, Any] = {"log": tmp_path / "a.mcap", "record": str(tmp_path / "." / "a.mcap")}
    with pytest.raises(
        InputError, match=r"log and record are the same file, .*a\.mcap; give two different files"
    ):
        Node(scenario(), domain=DOMAIN, **same)
    assert not list(tmp_path.iterdir())
    with pytest.raises(DtypeError, match=r"is 'humanoid_reach'; give a Simulation, or use Node\.of_scenario"):
        Node("humanoid_reach")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="pace is None; give one of real_time, fast, stepped"):
        Node(scenario(), pace=None)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="the timeout of wrenches is '1' s; it must be a positive"):
        Node(scenario(), wrench_timeout="1")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="the number of rows to keep is True; it must be an integer"):
        Node(scenario(), keep_rows=True)
    with node_of(scenario()) as one, pytest.raises(InputError, match="the duration is '1'; it must be a"):
        one.spin("1")  # type: ignore[arg-type]


def test_a_node_that_was_closed_does_not_run() -> None:
    with node_of(scenario(), pace="fast") as one:
        pass
    with pytest.raises(Ros2Error, match="or was closed; create another Node"):
        one.spin(0.01)


def test_an_error_of_dds_in_a_run_is_typed(monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    with node_of(scenario(), pace="fast", on_message=said.append) as one:
        reader = one._inbox._routes[0].reader
        monkeypatch.setattr(reader, "take", failing(NO_ROOM, 2, reader.take))
        with pytest.raises(Ros2Error, match=r"cannot continue the run \(.*create another Node"):
            one.spin(1.0)
    assert len(said) == 1 and said[0].startswith("run: failed: cannot continue the run")


@full
def test_a_log_on_a_full_disk_ends_the_run() -> None:
    """The command was obeyed; a run that went on could not be repeated from its log."""
    no_space = "cannot write /dev/full: No space left on device"
    with Peer() as peer, pytest.raises(OutputFolderError, match=no_space):  # noqa: SIM117
        with node_of(passive(), pace="stepped", log="/dev/full") as one:
            peer.say(*WRENCH)
            with pytest.raises(OutputFolderError, match=no_space):
                one.spin(0.1)
    assert len(one.commands) == 1 and not list(loopback.udp_sockets())


@pytest.mark.skipif(sys.platform != "linux", reason="the test limits the size of files as Linux does")
def test_a_recording_on_a_full_disk_is_an_error_and_leaves_the_old_file(tmp_path: Path) -> None:
    import resource
    import signal

    record = tmp_path / "run.mcap"
    record.write_text("precious")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, limits[1]))
    try:
        with pytest.raises(OutputFolderError, match=r"cannot write .*run\.mcap: File too large"):  # noqa: SIM117
            with node_of(scenario(), pace="fast", record=record) as one:
                with pytest.raises(OutputFolderError, match=r"cannot write .*run\.mcap: File too large"):
                    one.spin(2.0)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handler)
    assert not list(loopback.udp_sockets()), "the node has left its domain"
    assert [file.read_text() for file in tmp_path.iterdir()] == ["precious"]
