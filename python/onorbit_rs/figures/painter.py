"""Program of a helper process that draws figures for :mod:`onorbit_rs.output.painters`."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from onorbit_rs.common.processes import receive
from onorbit_rs.figures.drawings import Drawing, drawings
from onorbit_rs.figures.save import as_bytes
from onorbit_rs.figures.subject import Subject
from onorbit_rs.figures.world_drawings import world_drawings

if TYPE_CHECKING:
    from onorbit_rs.figures.world_subject import WorldSubject


def drawings_of(albums: Iterable[tuple[str, Subject | WorldSubject]]) -> Iterator[tuple[str, Drawing]]:
    """Yield the stem of the file name and the drawing of each figure of several subjects.

    ``albums`` are pairs of a prefix of the file names and a subject.
    """
    for prefix, subject in albums:
        found = drawings(subject) if isinstance(subject, Subject) else world_drawings(subject)
        for drawing in found:
            yield f"{prefix}{drawing.name}", drawing


def main() -> None:
    """Read subjects, then indices of figures, from stdin; write each figure to stdout as PNG.

    The length of a figure, 8 bytes in little-endian order, precedes its content. The process ends at the end
    of stdin, which it also reaches if its parent is killed.
    """
    albums = receive(sys.stdin.buffer)
    found = [drawing for _, drawing in drawings_of(albums)]
    out = sys.stdout.buffer
    while True:
        try:
            number = receive(sys.stdin.buffer)
        except EOFError:
            return
        content = as_bytes(found[number].draw(), "png")
        out.write(len(content).to_bytes(8, "little"))
        out.write(content)
        out.flush()
