"""Shell completion of arguments: suggests bundled names, then files and folders."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path


def scenario_names(incomplete: str) -> list[str]:
    """Return the bundled scenarios, YAML files and folders whose names begin with ``incomplete``."""
    from onorbit_rs import scenarios

    return [*_fitting(scenarios.names(), incomplete), *_files(incomplete, (".yaml", ".yml"))]


def campaign_names(incomplete: str) -> list[str]:
    """Return the bundled campaigns, YAML files and folders whose names begin with ``incomplete``."""
    from onorbit_rs.campaigns.bundled import CAMPAIGNS

    return [*_fitting(CAMPAIGNS.names(), incomplete), *_files(incomplete, (".yaml", ".yml"))]


def bundled_names(incomplete: str) -> list[str]:
    """Return the bundled scenarios and campaigns whose names begin with ``incomplete``."""
    from onorbit_rs import scenarios
    from onorbit_rs.campaigns.bundled import CAMPAIGNS

    return _fitting([*scenarios.names(), *CAMPAIGNS.names()], incomplete)


def robot_names(incomplete: str) -> list[str]:
    """Return the bundled robots, URDF and xacro files, and folders whose names begin with ``incomplete``."""
    from onorbit_rs import robots

    return [*_fitting(robots.names(), incomplete), *_files(incomplete, (".urdf", ".xacro"))]


def robot_and_scenario_names(incomplete: str) -> list[str]:
    """Return the robots and scenarios, bundled or in files, and folders that begin with ``incomplete``."""
    return list(dict.fromkeys([*robot_names(incomplete), *scenario_names(incomplete)]))


def _fitting(names: list[str], incomplete: str) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]


def _files(incomplete: str, endings: tuple[str, ...]) -> Iterator[str]:
    """Yield the folders, and the files with one of the endings, whose paths begin with ``incomplete``."""
    typed, _, start = incomplete.rpartition("/")
    prefix = f"{typed}/" if "/" in incomplete else ""
    try:
        entries = sorted(Path(prefix or ".").iterdir())
    except OSError:
        return
    for entry in entries:
        if entry.name.startswith(start) and (start or not entry.name.startswith(".")):
            if entry.is_dir():
                yield f"{prefix}{entry.name}/"
            elif entry.name.endswith(endings):
                yield f"{prefix}{entry.name}"
