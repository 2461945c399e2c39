"""``guided.py TARGET COUNT SECONDS SEED CORPUS WORK``: fuzzes one target, guided by Atheris.

Without Atheris, inputs are mutated without coverage. The last line of output is a report in JSON.
"""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path
from typing import Any

try:
    import atheris  # type: ignore[import-not-found]
except ImportError:
    atheris = None

LIMIT_S, LIMIT_MB, LONGEST = 60, 2048, 65_536


def main() -> None:
    name, count, seconds, seed, corpus, work = sys.argv[1:]
    if atheris is None:
        from tried import Trial, blind
    else:
        with atheris.instrument_imports(include=["onorbit_rs", "jplephem", "xacro"]):
            from tried import Trial, blind
    from targets import seeds

    trial = Trial(name, Path(work) / "findings", int(seed))
    kept, given = Path(work) / "corpus" / name, Path(corpus) / name
    kept.mkdir(parents=True, exist_ok=True)
    for index, data in enumerate(seeds(name, trial.room)):
        (kept / f"seed{index}").write_bytes(data)
    before, started, tried = len(list(kept.iterdir())), time.monotonic(), 0
    report: dict[str, Any] = {"parser": name}

    def done() -> None:
        report.update(
            inputs=tried, kept=len(list(kept.iterdir())) - before,
            seconds=round(time.monotonic() - started, 1), findings=len(trial.places),
        )  # fmt: skip
        trial.room.close()
        print(json.dumps(report), flush=True)

    if atheris is None:
        files = [*given.glob("*"), *kept.iterdir()]
        while tried < int(count) and time.monotonic() - started < float(seconds):
            tried += blind(trial, [file.read_bytes() for file in files], min(1000, int(count) - tried))
            trial.seed += 1
        done()
        os._exit(1 if trial.places else 0)

    def one(data: bytes) -> None:
        nonlocal tried
        tried += 1
        trial(data)
        # not in a timer thread, which would remove the files of the current input
        if tried >= int(count) or time.monotonic() - started >= float(seconds):
            done()
            os._exit(1 if trial.places else 0)  # libFuzzer would exit without a report

    folders = [str(kept)] + ([str(given)] if given.is_dir() else [])
    limits = [f"-timeout={LIMIT_S}", f"-rss_limit_mb={LIMIT_MB}", f"-max_len={LONGEST}"]
    options = [f"-seed={int(seed) or 1}", f"-artifact_prefix={work}/findings/{name}-", "-verbosity=0"]
    atheris.Setup([sys.argv[0], *folders, *limits, *options], one)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
