"""HTML of the table of a campaign for notebooks: success, results, and the cases without success.

Arrow tables have no HTML display, so one is registered with IPython. The metadata of a table, also in
``cases.parquet``, state which columns are dispersed values and which conditions define success.
"""

from __future__ import annotations

import json
import sys
from html import escape
from typing import TYPE_CHECKING, Any

from onorbit_rs.campaigns.document import Condition
from onorbit_rs.campaigns.report import reason
from onorbit_rs.campaigns.results import results
from onorbit_rs.campaigns.statistics import CONFIDENCE, wilson
from onorbit_rs.common.counting import count
from onorbit_rs.common.display_units import digits
from onorbit_rs.displays.cells import rows_html
from onorbit_rs.displays.fallback import or_plain

if TYPE_CHECKING:
    import pyarrow as pa

    from onorbit_rs.campaigns.results import Result

_KEY = b"onorbit.campaign"
_MOST_RESULTS = 9
_MOST_CASES = 10


def described(table: pa.Table, name: str, values: list[str], success: dict[str, Condition]) -> pa.Table:
    """Return the table with the name, the dispersed values and the conditions of its campaign as metadata."""
    about = {
        "name": name,
        "values": values,
        "success": {key: one.model_dump(mode="json", exclude_unset=True) for key, one in success.items()},
    }
    return table.replace_schema_metadata({**(table.schema.metadata or {}), _KEY: json.dumps(about)})


def campaign_html(table: pa.Table) -> str | None:
    """Return the success rate with bounds, the results that vary, and the cases without success as HTML.

    Returns None for a table without the metadata or the columns of a campaign.
    """
    about = json.loads((table.schema.metadata or {}).get(_KEY, b"null"))
    if about is None or not {"case", "status", "success", "error"} <= set(table.column_names):
        return None
    columns = table.to_pydict()
    cases, is_success = columns["case"], columns["success"]
    rate = wilson(sum(is_success), len(cases))
    head = (
        f"<b>Campaign {escape(about['name'])}</b>: success in {rate.successes} of "
        f"{count(rate.cases, 'case', 'cases')}, "
        f"{rate.fraction:.1%} ({rate.low:.1%} to {rate.high:.1%} with {CONFIDENCE:.0%} confidence)"
    )
    conditions = {key: Condition.model_validate(one) for key, one in about["success"].items()}
    found = results(columns, about["values"], list(conditions))
    heads = ("result", "unit", "smallest", "median", "largest", "cases with the largest")
    shown = rows_html([_row(one, cases) for one in found[:_MOST_RESULTS]], heads) if found else ""
    if more := len(found) - _MOST_RESULTS:
        shown += f"<div>Further results that vary: {more}</div>" if more > 0 else ""
    failed = [index for index, has in enumerate(is_success) if not has]
    if failed:
        rows = [(str(cases[i]), columns["status"][i], reason(columns, i, conditions))
                for i in failed[:_MOST_CASES]]  # fmt: skip
        rest = f" The first {_MOST_CASES} of {len(failed)}:" if len(failed) > _MOST_CASES else ""
        shown += f"<div>Cases without success.{rest}</div>{rows_html(rows, ('case', 'status', 'reason'))}"
    return f"<div>{head}{shown}</div>"


def show_tables() -> None:
    """Register the display of campaign tables with IPython, if it is running."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    if shell is None:
        return
    import pyarrow as pa

    formatter = shell.display_formatter.formatters["text/html"]
    before = formatter.for_type(pa.Table)
    if getattr(before, "is_of_campaigns", False):
        return

    def html(table: pa.Table) -> str | None:
        shown = or_plain(campaign_html, table)
        return before(table) if shown is None and before is not None else shown

    html.is_of_campaigns = True  # type: ignore[attr-defined]
    formatter.for_type(pa.Table, html)


def _row(result: Result, cases: list[Any]) -> tuple[str, ...]:
    """Return label, unit, smallest, median and largest value, and the cases with the three largest values."""
    import numpy as np

    is_given = np.isfinite(result.values)
    given = result.values[is_given]
    order = np.argsort(-given, kind="stable")[:3]
    largest = ", ".join(str(cases[int(index)]) for index in np.flatnonzero(is_given)[order])
    numbers = (float(given.min()), float(np.median(given)), float(given.max()))
    return (result.label, result.unit, *map(digits, numbers), largest)
