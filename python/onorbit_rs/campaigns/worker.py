"""Worker process of a campaign: ``python -m onorbit_rs.campaigns.worker``, started by ``on_processes``.

The first message on standard input is the plan and the search path of modules; each further message is a list
of cases. Standard output has two pickled messages per case: its number when it begins, and its outcome. The
process ends when its standard input is closed, which also happens if the process that started it dies.
"""

from __future__ import annotations

import os
import queue
import sys
import threading
import warnings
from typing import BinaryIO

from onorbit_rs.campaigns.cases import run_case
from onorbit_rs.common.processes import receive, send


def main() -> None:
    """Run the cases that arrive on standard input."""
    results = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of user code must not mix with the results
    plan, path = receive(sys.stdin.buffer)
    sys.path[:] = path
    warnings.simplefilter("ignore")  # the nominal scenario has issued them
    requests: queue.SimpleQueue[list[int]] = queue.SimpleQueue()
    threading.Thread(target=_read, args=(sys.stdin.buffer, requests), daemon=True).start()
    while True:
        for case in requests.get():
            send(results, case)
            send(results, run_case(plan, case))


def _read(stream: BinaryIO, requests: queue.SimpleQueue[list[int]]) -> None:
    """Read requests until the stream is closed; then end the process, even during a case."""
    while True:
        try:
            requests.put(receive(stream))
        except (EOFError, OSError):
            os._exit(0)


if __name__ == "__main__":
    main()
