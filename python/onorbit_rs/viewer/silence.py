"""Imports rerun with its log off: what goes wrong in there is told by our own errors and warnings.

Rerun reads ``RUST_LOG`` once, when it is first imported; who sets it gets what it asks for.
"""

from __future__ import annotations

import os

if "RUST_LOG" in os.environ:
    import rerun
else:
    os.environ["RUST_LOG"] = "off"
    try:
        import rerun
    finally:
        del os.environ["RUST_LOG"]

__all__ = ["rerun"]
