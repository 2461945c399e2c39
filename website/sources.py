"""Replaces links to source files of the engine by links to copies within the site.

In the repository, the link ``../crates/core/src/x.rs`` leads to the file itself; the site contains a copy as
text.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import Any

from markdown import Extension, Markdown
from markdown.preprocessors import Preprocessor

SOURCES = Path("crates/core/src")
LINK = re.compile(rf"\]\(((?:\.\./)*)\.\./({SOURCES.as_posix()}/[\w/]+\.rs)\)")


class Sources(Preprocessor):
    """Replaces the targets of links to source files."""

    def run(self, lines: list[str]) -> list[str]:
        """Returns the lines with links to the copies."""
        return LINK.sub(r"](\1sources/\2.txt)", "\n".join(lines)).split("\n")


class SourcesExtension(Extension):
    """Registers the preprocessor."""

    def extendMarkdown(self, md: Markdown) -> None:
        """Registers the preprocessor after that of fenced code blocks, which has priority 25."""
        md.preprocessors.register(Sources(md), "sources", 23)


def copy_sources(site: Path) -> None:
    """Copies the source files of the engine into the built site, as text that a browser shows."""
    for file in SOURCES.rglob("*.rs"):
        copy = site / "sources" / file.with_name(f"{file.name}.txt")
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, copy)


def makeExtension(**options: Any) -> SourcesExtension:
    """Returns the extension; Markdown calls this function."""
    return SourcesExtension(**options)
