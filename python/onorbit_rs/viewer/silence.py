"""Imports rerun with its log off; errors are reported by the exceptions and warnings of this package.

Rerun reads ``RUST_LOG`` once, at its first import; a value set by the user is respected.
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
