"""Worker process of a campaign: ``python -m onorbit_rs.campaigns.worker``, started by ``on_processes``.

The first message on standard input is the plan, the search path of modules, and the folder of the campaign if
the cases are kept in full; each further message is a list of cases. Standard output has two pickled messages
per case: its number when it begins, and its outcome, or the error with which it could not be kept. The
process ends when its standard input is closed, which also happens if the process that started it dies.
"""

from __future__ import annotations

import os
import queue
import sys
import threading
import warnings
from typing import TYPE_CHECKING, BinaryIO

from onorbit_rs.campaigns.cases import keep_case, run_case
from onorbit_rs.campaigns.failure_folders import failure_folder
from onorbit_rs.common.processes import receive, send
from onorbit_rs.exceptions import OutputFolderError

if TYPE_CHECKING:
    from pathlib import Path

    from onorbit_rs.campaigns.cases import Outcome
    from onorbit_rs.campaigns.plan import Plan


def main() -> None:
    """Run the cases that arrive on standard input."""
    results = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # output of user code must not mix with the results
    plan, path, kept = receive(sys.stdin.buffer)
    sys.path[:] = path
    warnings.simplefilter("ignore")  # the nominal scenario has issued them
    requests: queue.SimpleQueue[list[int]] = queue.SimpleQueue()
    threading.Thread(target=_read, args=(sys.stdin.buffer, requests), daemon=True).start()
    while True:
        for case in requests.get():
            send(results, case)
            send(results, run_case(plan, case) if kept is None else _kept(plan, case, kept))


def _kept(plan: Plan, case: int, folder: Path) -> Outcome | OutputFolderError:
    try:
        return keep_case(plan, case, failure_folder(folder, case))
    except OutputFolderError as error:
        return error


def _read(stream: BinaryIO, requests: queue.SimpleQueue[list[int]]) -> None:
    """Read requests until the stream is closed; then end the process, even during a case."""
    while True:
        try:
            requests.put(receive(stream))
        except (EOFError, OSError):
            os._exit(0)


if __name__ == "__main__":
    main()
