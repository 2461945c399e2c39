"""Builds the site and checks it: a word from any of the tools that is no progress is an error.

Run from the repository's root: python website/build.py
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

from links import complaints

SITE = Path("out/docs")
PROGRESS = re.compile(r"Build started|Build finished in .*|No issues found|")


def main() -> int:
    """0 where there is nothing to say."""
    shutil.rmtree(SITE, ignore_errors=True)
    command = [sys.executable, "-m", "zensical", "build", "--strict", "--clean"]
    told = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    lines = [line for line in told.stdout.splitlines() if not PROGRESS.fullmatch(line)]
    found, outside = complaints(SITE) if told.returncode == 0 else ([], set())
    print(*lines, *found, sep="\n", end="\n" if lines or found else "")
    if told.returncode or lines or found:
        return 1
    pages = len(list(SITE.rglob("*.html")))
    print(f"{pages} pages; links that lead elsewhere, not followed: {', '.join(sorted(outside))}")
    print(f"open {(SITE / 'index.html').resolve().as_uri()}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
