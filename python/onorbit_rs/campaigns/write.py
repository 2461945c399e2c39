"""Writes ``campaign.yaml`` and the tables of a campaign."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any

import yaml

from onorbit_rs.campaigns.storage import CAMPAIGN, COLUMNS, TABLE
from onorbit_rs.campaigns.table import arrow, write_table
from onorbit_rs.common.files import remove, replacing

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyarrow as pa

    from onorbit_rs.campaigns.document import CampaignDocument
    from onorbit_rs.campaigns.plan import Plan
    from onorbit_rs.campaigns.storage import CampaignFolder


def resolved(document: CampaignDocument, scenario: dict[str, Any]) -> dict[str, Any]:
    """Return a campaign as plain data in SI, with all defaults and the whole scenario."""
    data: dict[str, Any] = document.model_dump(mode="json", exclude_none=True, by_alias=True)
    data["campaign"]["scenario"] = scenario
    for change in data["campaign"]["vary"].values():
        if change["vector"] == "components":
            del change["vector"]
    return data


def write_campaign(folder: CampaignFolder, document: CampaignDocument, scenario: dict[str, Any]) -> None:
    """Write ``campaign.yaml``, which runs the same campaign from any folder."""
    source = document.file or "Python"
    header = (
        f"# resolved by onorbit_rs from {source}; run it again with: "
        "onorbit campaign campaign.yaml --out DIR\n"
    )
    text = yaml.safe_dump(
        resolved(document, scenario), sort_keys=False, default_flow_style=None, width=110, allow_unicode=True
    )
    folder.write(CAMPAIGN, (header + text).encode())


def write_cases(folder: CampaignFolder, table: pa.Table) -> None:
    """Write ``cases.parquet``."""
    with replacing(folder.path / TABLE) as temporary:
        write_table(table, temporary)


def write_columns(folder: CampaignFolder, plan: Plan, cases: Sequence[int]) -> None:
    """Write ``columns.parquet``: one row per case and kept time, in the order of the cases.

    Only the columns of one case are in memory at a time; the file has one row group per case. If no case has
    columns, as when all cases failed, the file is removed.
    """
    if not plan.keep.columns:
        return
    found = folder.columns(cases)
    first = next(found, None)
    if first is None:
        remove(folder.path / COLUMNS)
        return
    pa = arrow()
    import pyarrow.parquet as pq

    with replacing(folder.path / COLUMNS) as temporary:
        writer = None
        try:
            for case, columns in chain([first], found):
                rows = len(columns["time"])
                table = pa.table({"case": pa.array([case] * rows, pa.int64()), **columns})
                writer = writer or pq.ParquetWriter(temporary, table.schema, compression="zstd")
                writer.write_table(table)
        finally:
            if writer is not None:
                writer.close()
