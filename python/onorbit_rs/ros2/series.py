"""A topic whose messages are computed from the rows of a run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from onorbit_rs.ros2.messages import Template
    from onorbit_rs.ros2.rows import Rows

    Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Series:
    """A topic with one message per row of a system; ``values`` fills the fields of ``template``."""

    name: str
    system: str
    template: Template
    values: Callable[[Rows], dict[str, Floats]]

    @property
    def kind(self) -> str:
        """Type of the messages."""
        return self.template.kind

    def messages(self, rows: Rows) -> NDArray[np.uint8]:
        """Return the messages (T, size), in CDR, of the rows."""
        return self.template.fill(rows.time, self.values(rows))
