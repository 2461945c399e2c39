"""Runs the notebooks whole, in Jupyter: ``make test-notebooks``.

Run: python tests/run_notebooks.py [NAME…] [--out DIR]
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from notebook_cells import NOTEBOOKS, path_of, unexpected_lines

KINDS = {
    "oo.show(": "application/vnd.jupyter.widget-view+json", "oo.plot(": "image/png",
    "plt.show(": "image/png", "oo.campaign(": "text/html",
}  # fmt: skip
"""What a cell with a call must display."""
PATIENCE_S = 900


def run(name: str, out: Path | None) -> list[str]:
    """Runs a notebook in an empty folder and returns what is wrong with it; keeps it with its outputs."""
    notebook = nbformat.read(path_of(name), as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        client = NotebookClient(
            notebook, timeout=PATIENCE_S, kernel_name="python3", extra_arguments=["--log-level=ERROR"],
            resources={"metadata": {"path": folder}},
        )  # fmt: skip
        try:
            client.execute()
        except CellExecutionError as error:
            return [str(error)]
        finally:
            if out is not None:
                nbformat.write(notebook, out / f"{name}.ipynb")
    return problems(notebook, name)


def problems(notebook: nbformat.NotebookNode, name: str) -> list[str]:
    """Returns unexpected lines on stderr, and cells that ask for a viewer or a plot and display none."""
    found = []
    for cell in notebook.cells:
        outputs = cell.get("outputs", ())
        shown = {kind for output in outputs for kind in output.get("data", {})}
        for output in outputs:
            if output.output_type == "stream" and output.name == "stderr":
                found += [f"unexpected on stderr: {line}" for line in unexpected_lines(output.text, name)]
        if cell.cell_type != "code":
            continue
        for call, kind in KINDS.items():
            if call in cell.source and kind not in shown:
                found.append(f"no {kind} below: {cell.source}")
    return found


def main() -> int:
    """Runs all notebooks or those named, and prints the time of each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", default=NOTEBOOKS, metavar="NAME")
    parser.add_argument("--out", type=Path, help="folder for the notebooks with their outputs")
    given = parser.parse_args()
    if given.out is not None:
        given.out.mkdir(parents=True, exist_ok=True)
    failed = 0
    for name in given.names:
        begin = time.monotonic()
        wrong = run(name, given.out)
        print(f"{name:14} {time.monotonic() - begin:6.1f} s  {'FAILED' if wrong else 'passed'}", flush=True)
        for line in wrong:
            print(f"    {line}")
        failed += bool(wrong)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
