"""Builds the website and checks it: any output of the tools other than progress is an error.

Run from the root of the repository: python website/build.py
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys

from links import SITE, problems
from sources import copy_sources

PROGRESS = re.compile(r"Build started|Build finished in .*|No issues found|")


def main() -> int:
    """Returns 0 if the site was built without errors or warnings and all internal links have a target."""
    shutil.rmtree(SITE, ignore_errors=True)
    command = [sys.executable, "-m", "zensical", "build", "--strict", "--clean"]
    built = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    lines = [line for line in built.stdout.splitlines() if not PROGRESS.fullmatch(line)]
    if built.returncode == 0:
        copy_sources(SITE)
    found, outside = problems(SITE) if built.returncode == 0 else ([], set())
    print(*lines, *found, sep="\n", end="\n" if lines or found else "")
    if built.returncode or lines or found:
        return 1
    pages = len(list(SITE.rglob("*.html")))
    print(f"built {pages} pages; external links were not checked: {', '.join(sorted(outside))}")
    print(f"open {(SITE / 'index.html').resolve().as_uri()}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
