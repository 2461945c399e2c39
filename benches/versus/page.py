"""Writer of the measured part of ``docs/performance.md``, which every saved run updates."""

from __future__ import annotations

from pathlib import Path
from typing import Any

PAGE = Path(__file__).parents[2] / "docs" / "performance.md"
BEGIN, END = "<!-- measured: written by make bench -->", "<!-- end of what is measured -->"

NAMES = {
    "aba": "ABA",
    "crba": "CRBA",
    "rnea": "RNEA",
    "jacobian": "frame Jacobian and drift",
    "reduced": "M*, c*, Jg, d together",
}
SINE_AND_COSINE = 49  # operations of one pair: reduction, two polynomials, signs (spatial/sine.rs)

Run = dict[str, Any]


def flops(operations: dict[str, int]) -> int:
    """Returns the number of floating-point operations of a kernel.

    A fused multiply-add counts as two, a division or root as one, and a pair of sine and cosine as the
    operations of its polynomials.
    """
    once = sum(operations[name] for name in ("add", "mul", "div", "sqrt"))
    return once + 2 * operations["mul_add"] + SINE_AND_COSINE * operations["sin_cos"]


def head(*columns: str) -> list[str]:
    return [f"| {' | '.join(columns)} |", "|-" * len(columns) + "|"]


def ratios(run: Run) -> list[str]:
    lines = head("task", "nv", "compared with", "ratio", "rounds", "required", "differ by")
    for row in run["rows"]:
        ratio, goal = row["ratio"], row["asked"]
        lines.append(
            f"| {row['what']} | {row['nv']} | {row['against']} | **{ratio['median']:.2f}** | "
            f"{ratio['min']:.1f} to {ratio['max']:.1f} | {'' if goal is None else f'{goal:g}'} | "
            f"{row['difference']:.0e} |"
        )
    return lines


def limits(run: Run) -> list[str]:
    """Returns the lines of the table of operations and times, for one state and for a batch with SIMD."""
    kinds = ("ns, one state", "of a lane's peak", "ns, in a batch", "of the lanes' peak")
    lines = head("kernel", "nv", "operations", *kinds)
    times = {(row["what"], row["nv"]): row["ours_ns"] for row in run["rows"]}
    for entry in run["ceiling"]:
        nv, peaks = entry["nv"], entry["peak_gflops"]
        widest = max(peaks.values())
        lane = peaks.get("avx2+fma", 0.0) / 4 or widest
        for name, operations in entry["operations"].items():
            done, one = flops(operations), times.get((NAMES[name], nv))
            if one is None:
                continue
            batch = times.get(("batch forward dynamics", nv)) if name == "aba" else None
            lanes = f"{batch:.0f} | {done / batch / widest:.0%}" if batch else " | "
            lines.append(f"| {NAMES[name]} | {nv} | {done} | {one:.0f} | {done / one / lane:.0%} | {lanes} |")
    return lines


def measured(run: Run) -> str:
    versions = ", ".join(f"{name} {version}" for name, version in run["versions"].items() if version)
    peaks = ", ".join(f"{name} {peak:g}e9" for name, peak in run["ceiling"][0]["peak_gflops"].items())
    lines = [
        f"{run['date']}, commit {run['commit']}, {run['rounds']} rounds, on: {run['machine']}; {versions}.",
        "",
        *ratios(run),
        "",
        f"Peak throughput of one core, operations per second: {peaks}.",
        "",
        *limits(run),
    ]
    return "\n".join(lines)


def update(run: Run) -> None:
    before, rest = PAGE.read_text().split(BEGIN)
    PAGE.write_text(f"{before}{BEGIN}\n{measured(run)}\n{END}{rest.split(END)[1]}")
