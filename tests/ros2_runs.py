"""Nodes in a DDS domain of this process, and another process that listens and speaks to them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import onorbit_rs as oo
from onorbit_rs.exceptions import Ros2Error
from onorbit_rs.ros2.extra import require

if TYPE_CHECKING:
    from onorbit_rs.ros2 import Node

DOMAIN = 1 + os.getpid() % 230
"""Tests that run at the same time must not hear each other."""


def needs_ros2() -> None:
    """Skips the tests of a module if the extra is not installed."""
    try:
        require("rosbags", "cyclonedds")
    except Ros2Error as error:
        pytest.skip(str(error), allow_module_level=True)


OPEN: list[list[int]] = []
"""Identities of the nodes of this process: a peer may still see those of earlier tests."""


class Peer:
    """The process of `ros2_peer.py`; its methods are called by name."""

    def __init__(self, domain: int = DOMAIN) -> None:
        script = Path(__file__).parent / "ros2_peer.py"
        self.process = subprocess.Popen(
            [sys.executable, str(script), str(domain)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        )  # fmt: skip

    def __getattr__(self, name: str) -> Any:
        def call(*values: Any, **options: Any) -> Any:
            names = ("topic", "count" if name == "take" else "kind", "values")
            options |= dict(zip(names, values, strict=False))
            if name in ("say", "publisher"):
                options.setdefault("nodes", OPEN)
            assert self.process.stdin is not None and self.process.stdout is not None
            self.process.stdin.write(json.dumps([name, options]) + "\n")
            self.process.stdin.flush()
            return json.loads(self.process.stdout.readline())

        return call

    def __enter__(self) -> Peer:
        return self

    def __exit__(self, *_: object) -> None:
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.close()
        self.process.wait(5)
        self.process.stdout.close()


@contextmanager
def node_of(run: oo.Simulation, **options: Any) -> Iterator[Node]:
    """Yields a node in the DDS domain of this process; the node leaves the domain at the end of the block."""
    from onorbit_rs.ros2 import Node

    node = Node(run, domain=DOMAIN, **options)
    identity = list(node._participant._entity.get_guid().bytes)
    OPEN.append(identity)
    try:
        yield node
    finally:
        OPEN.remove(identity)
        node.close()


@contextmanager
def spinning(node: Node, duration: float | None = None) -> Iterator[list[Any]]:
    """Runs a node in a thread; the list contains its trace at the end of the block."""
    found: list[Any] = []
    thread = threading.Thread(target=lambda: found.append(node.spin(duration)), daemon=True)
    thread.start()
    try:
        yield found
    finally:
        thread.join(30)
        assert not thread.is_alive()


def wait_for_subscriber(node: Node, *topics: str) -> None:
    """Waits until a node has found subscribers of topics."""
    end = time.monotonic() + 20.0
    while not all(node._publisher._writers[topic].subscribers() for topic in topics):
        assert time.monotonic() < end
        time.sleep(0.005)
