"""Runs ``onorbit`` as ``python -m onorbit_rs``."""

from onorbit_rs.cli import main

main()
