"""Every example in a docstring of the Python package runs."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import onorbit_rs


def test_examples_in_docstrings_run() -> None:
    names = [
        "onorbit_rs",
        *(module.name for module in pkgutil.walk_packages(onorbit_rs.__path__, "onorbit_rs.")),
    ]
    ran = 0
    for name in names:
        if name.endswith(("__main__", "_core")):
            continue
        result = doctest.testmod(importlib.import_module(name))
        assert result.failed == 0, name
        ran += result.attempted
    assert ran >= 4
