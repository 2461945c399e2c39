"""Converts equations to MathML when the site is built, so that pages require neither scripts nor network.

The syntax is that of GitHub: ``$…$`` within a line, and ``$$`` on separate lines around a displayed equation.
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
    """Converts displayed equations before other Markdown syntax is processed."""

    def run(self, lines: list[str]) -> list[str]:
        """Returns the lines with a placeholder for each equation."""

        def stash(found: re.Match[str]) -> str:
            equation = self.md.htmlStash.store(f'<div class="equation">{mathml(found[1], "block")}</div>')
            return f"\n{equation}\n"

        return BLOCK.sub(stash, "\n".join(lines)).split("\n")


class Inline(InlineProcessor):
    """Converts equations within a line."""

    def handleMatch(self, m: re.Match[str], data: str) -> tuple[Element | str, int, int]:  # type: ignore[override]
        """Returns the placeholder of an equation, and the start and end of the equation in the text."""
        return self.md.htmlStash.store(mathml(m[1], "inline")), m.start(0), m.end(0)


class Number(InlineProcessor):
    """Prevents a line break within numbers such as ``1e-7``."""

    def handleMatch(self, m: re.Match[str], data: str) -> tuple[Element | str, int, int]:  # type: ignore[override]
        """Returns a span element with the number, and the start and end of the number in the text."""
        span = Element("span", {"class": "number"})
        span.text = m[1]
        return span, m.start(0), m.end(0)


def mathml(tex: str, display: str) -> str:
    """Returns an equation as MathML; raises ValueError for unknown TeX."""
    if unknown := re.findall(r"<m[io]>(\\\w+)</m[io]>", converted := convert(tex.strip(), display=display)):
        raise ValueError(f"{unknown[0]} in {tex!r} is not supported; write the equation without this command")
    return converted


class Equations(Extension):
    """Registers the processors of equations."""

    def extendMarkdown(self, md: Markdown) -> None:
        """Registers displayed equations after fenced code (25) and inline ones after inline code (190)."""
        md.preprocessors.register(Blocks(md), "equations", 24)
        md.inlinePatterns.register(Inline(INLINE, md), "equation", 185)
        md.inlinePatterns.register(Number(NUMBER, md), "number", 5)


def makeExtension(**options: Any) -> Equations:
    """Returns the extension; Markdown calls this function."""
    return Equations(**options)
