"""A table of measured values beside their gates."""

from __future__ import annotations


class Report:
    """Rows of a table. A row that is not required depends on the load of the machine."""

    def __init__(self) -> None:
        self.rows: list[tuple[str, str, str, str]] = []
        self.has_failed = False

    def check(
        self, what: str, passed: bool, measured: object = "", gate: str = "", required: bool = True
    ) -> None:
        """Adds a row."""
        verdict = "passed" if passed else ("FAILED" if required else "missed")
        self.has_failed |= required and not passed
        self.rows.append((what, str(measured), gate, verdict))

    def show(self) -> None:
        """Prints the table."""
        head = ("what", "measured", "gate", "")
        widths = [max(len(row[k]) for row in (head, *self.rows)) for k in range(4)]
        for row in (head, *self.rows):
            print("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())
