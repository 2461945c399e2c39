"""The ``onorbit`` command line. Each command has one file and imports other modules when it is called."""

from onorbit_rs.cli.app import main

__all__ = ["main"]
