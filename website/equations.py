"""Equations as MathML, written when the site is built: a browser needs neither a script nor the network.

``$…$`` in a line, ``$$ … $$`` on lines of its own; TeX inside, as GitHub reads it too.
"""

from __future__ import annotations

import re
from typing import Any
from xml.etree.ElementTree import Element

from latex2mathml.converter import convert
from markdown import Extension, Markdown
from markdown.inlinepatterns import InlineProcessor
from markdown.preprocessors import Preprocessor

BLOCK = re.compile(r"^\$\$\n(.*?)\n\$\$$", re.MULTILINE | re.DOTALL)
NUMBER = r"(\d\.?\d*e-\d+)"
INLINE = r"(?<![\\$\w])\$(?!\s)([^$\n]+?)(?<!\s)\$(?![$\w])"


class Blocks(Preprocessor):
    """Displayed equations; what is inside of them is kept from the rest of Markdown."""

    def run(self, lines: list[str]) -> list[str]:
        """The same lines with a placeholder for each equation."""

        def stash(found: re.Match[str]) -> str:
            equation = self.md.htmlStash.store(f'<div class="equation">{mathml(found[1], "block")}</div>')
            return f"\n{equation}\n"

        return BLOCK.sub(stash, "\n".join(lines)).split("\n")


class Inline(InlineProcessor):
    """Equations within a line."""

    def handleMatch(self, m: re.Match[str], data: str) -> tuple[Element | str, int, int]:  # type: ignore[override]
        """The placeholder, and what it stands for."""
        return self.md.htmlStash.store(mathml(m[1], "inline")), m.start(0), m.end(0)


class Number(InlineProcessor):
    """``1e-7`` stays on one line."""

    def handleMatch(self, m: re.Match[str], data: str) -> tuple[Element | str, int, int]:  # type: ignore[override]
        """In a span of its own."""
        span = Element("span", {"class": "number"})
        span.text = m[1]
        return span, m.start(0), m.end(0)


def mathml(tex: str, display: str) -> str:
    """One equation; TeX that is not understood would come out as its own name and is refused."""
    if unknown := re.findall(r"<m[io]>(\\\w+)</m[io]>", converted := convert(tex.strip(), display=display)):
        raise ValueError(f"{unknown[0]} in {tex!r} is not understood: write it another way")
    return converted


class Equations(Extension):
    """Registers them."""

    def extendMarkdown(self, md: Markdown) -> None:
        """After fenced code was taken away (25), before paragraphs; in a line after code in ticks (190)."""
        md.preprocessors.register(Blocks(md), "equations", 24)
        md.inlinePatterns.register(Inline(INLINE, md), "equation", 185)
        md.inlinePatterns.register(Number(NUMBER, md), "number", 5)


def makeExtension(**options: Any) -> Equations:
    """What Markdown calls."""
    return Equations(**options)
