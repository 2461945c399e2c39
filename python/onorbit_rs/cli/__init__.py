"""The command ``onorbit``: one file per command, which loads what it needs when it is called."""

from onorbit_rs.cli.app import main

__all__ = ["main"]
