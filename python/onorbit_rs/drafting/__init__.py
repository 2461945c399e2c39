"""A first scenario for a robot: which arm, from where, whereto; tried before it is handed out."""

from __future__ import annotations

from onorbit_rs.drafting.source import Source
from onorbit_rs.drafting.write import Draft, draft

__all__ = ["Draft", "Source", "draft"]
