"""The report page of a run: its verdict, numbers, certificate, figures and scenario."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from onorbit_rs.common.display_units import digits
from onorbit_rs.output.checks import Check, advice, checks, is_incomplete
from onorbit_rs.output.summary_labels import EXCEEDED
from onorbit_rs.report import template
from onorbit_rs.report.numbers import Row, groups
from onorbit_rs.report.template import Picture, Verdict, figure_html

_VERDICTS = {True: ("passed", "holds"), False: ("failed", "BROKEN"), None: ("faint", "not evaluated")}
_CERTIFICATE = """
<h2>Certificate</h2>
<p class="faint">Conserved quantities and consistency of the results, computed from the trace independently
of the integrator. Relative values are fractions of the run's scales (momentum, energy, inertial forces). A
check holds if its value is at most its gate.</p>
"""


@dataclass(frozen=True)
class Content:
    """Parts of a page as HTML: numbers, certificate and figures."""

    numbers: str
    checks: str
    figures: str


def page(
    summary: dict[str, Any],
    *,
    description: str,
    scenario: str,
    pictures: Sequence[Picture],
    remarks: Sequence[str],
    again: str,
    version: str,
) -> str:
    """Return the HTML of a report, without references to other files."""
    content = Content(
        numbers_section("Numbers", groups(summary)),
        checks_table(checks(summary)),
        "\n".join(map(figure_html, pictures)),
    )
    return filled(summary, content, description, scenario, warnings_of(summary), remarks, again, version)


def filled(
    summary: dict[str, Any],
    content: Content,
    description: str,
    scenario: str,
    warnings: Sequence[str],
    remarks: Sequence[str],
    again: str,
    version: str,
) -> str:
    """Return the template filled with the parts of a page; user-defined texts are escaped."""
    return template.filled(
        name=summary.get("scenario") or "run",
        what="onorbit report",
        description=description,
        verdict=_verdict(summary),
        warnings=[*warnings, *remarks],
        numbers=f"{content.numbers}{_CERTIFICATE}{content.checks}",
        figures=content.figures or "<p>This run has no figures.</p>",
        source="Scenario",
        text=scenario,
        again=again,
        version=version,
    )


def numbers_section(title: str, found: Sequence[tuple[str, Sequence[Row]]]) -> str:
    """Return the HTML of tables of numbers under a heading."""
    tables = "\n".join(_table(name, rows) for name, rows in found)
    return f'<h2>{escape(title)}</h2>\n<div class="tables">\n{tables}\n</div>'


def _verdict(summary: dict[str, Any]) -> Verdict:
    """Return the verdict: passed, failed, incomplete or absent, and whether the run reached its end."""
    status = str(summary.get("status") or "unknown")
    is_whole = status == "complete"
    has_passed = summary.get("certificate_passed")
    simulated = summary.get("simulated_s")
    text = f"Run {status}" + (
        f", {digits(simulated)} s simulated" if isinstance(simulated, (int, float)) else ""
    )
    if has_passed is None:
        certificate, kind = "Certificate absent: nothing was checked", "neutral"
    elif has_passed and is_incomplete(summary):
        absent = ", ".join(check.name for check in checks(summary) if check.holds is None)
        absent = absent or str(summary.get("certificate_not_evaluated") or "unknown check")
        certificate, kind = f"Certificate incomplete, not evaluated: {absent}", "warned"
    elif has_passed:
        certificate, kind = "Certificate passed", "passed" if is_whole else "warned"
    else:
        broken = ", ".join(check.name for check in checks(summary) if check.holds is False)
        broken = broken or str(summary.get("certificate_failures") or "unknown check")
        certificate, kind = f"Certificate FAILED: {broken}", "failed"
        if is_whole and (words := advice(summary)):
            text += f". {words[0].upper()}{words[1:]}"
    return Verdict(kind, certificate, f"{text}.")


def warnings_of(summary: dict[str, Any]) -> list[str]:
    """Return the warnings of a run, and the limits that its joints exceeded."""
    return [
        *str(summary.get("warnings") or "").splitlines(),
        *(f"{what} were exceeded: {summary[key]}" for key, what in EXCEEDED.items() if summary.get(key)),
    ]


def _table(title: str, rows: Sequence[Row]) -> str:
    lines = "\n".join(
        f'<tr><td>{escape(row.name)}</td><td class="number">{data_html(row)}</td>'
        f'<td class="unit">{escape(row.unit)}</td></tr>'
        for row in rows
    )
    return f"<section><h3>{escape(title)}</h3><table>{lines}</table></section>"


def data_html(row: Row) -> str:
    """Return the formatted value, with the value of ``summary.json`` as an attribute."""
    return f'<data id="{escape(row.key)}" value="{escape(str(row.value))}">{escape(row.shown)}</data>'


def checks_table(found: Sequence[Check]) -> str:
    """Return an HTML table of the checks of a certificate."""
    lines = "\n".join(map(_check, found))
    head = (
        '<th scope="col">{}</th><th scope="col" class="number">{}</th><th scope="col" class="number">{}</th>'
    )
    head = head.format("check", "value", "gate") + '<th scope="col">unit</th><th scope="col">verdict</th>'
    table = f'<div class="scroll"><table class="checks"><thead><tr>{head}</tr></thead>{lines}</table></div>'
    return table if lines else "<p>This run has no certificate.</p>"


def _check(check: Check) -> str:
    """Return the table row of a check: value, gate and verdict."""
    kind, verdict = _VERDICTS[check.holds]
    value, gate = ("-" if number is None else f"{number:.2g}" for number in (check.value, check.gate))
    if check.holds is not None:
        shown = "not finite" if check.value is None else value
        value = data_html(Row(check.key, check.name, check.value, shown, check.unit))
    return (
        f'<tr><td>{escape(check.name)}</td><td class="number">{value}</td><td class="number">{gate}</td>'
        f'<td class="unit">{escape(check.unit)}</td><td class="{kind}">{verdict}</td></tr>'
    )
