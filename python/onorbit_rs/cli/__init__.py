"""The ``onorbit`` command line. Each command has one file, which imports other modules only when called."""

from onorbit_rs.cli.app import main

__all__ = ["main"]
