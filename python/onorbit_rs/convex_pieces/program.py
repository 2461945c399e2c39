"""Program that divides a mesh with CoACD.

Reads the arrays ``vertices`` and ``triangles`` from standard input, and the options from the first argument.
Writes one row per corner to standard output: the index of its piece and its coordinates.
"""

import io
import json
import os
import sys

import coacd
import numpy as np


def main() -> None:
    """Divide the mesh and write its pieces; exit with an error if CoACD finds none."""
    output = os.dup(1)
    os.dup2(2, 1)  # what the library prints goes to standard error
    coacd.set_log_level("off")
    with np.load(io.BytesIO(sys.stdin.buffer.read()), allow_pickle=False) as given:
        mesh = coacd.Mesh(given["vertices"], given["triangles"])
    found = coacd.run_coacd(mesh, **json.loads(sys.argv[1]))
    rows = [np.column_stack([np.full(len(corners), i), corners]) for i, (corners, _) in enumerate(found)]
    if not rows:
        raise SystemExit("it found no pieces")
    content = io.BytesIO()
    np.save(content, np.vstack(rows), allow_pickle=False)
    with os.fdopen(output, "wb") as file:
        file.write(content.getvalue())


if __name__ == "__main__":
    main()
