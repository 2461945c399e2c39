"""``python -m onorbit_rs`` is ``onorbit``."""

from onorbit_rs.cli import main

main()
