"""Bundled campaigns, one YAML file each."""

from __future__ import annotations

from pathlib import Path

from onorbit_rs.common.bundled_files import BundledFiles

CAMPAIGNS = BundledFiles("campaign", Path(__file__).parent, ".yaml")
"""Campaigns for ``onorbit campaign`` and :func:`onorbit_rs.campaign`."""
