"""Reads the built site: every link within it leads somewhere, and nothing of it comes from elsewhere."""

from __future__ import annotations

from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {("script", "src"), ("img", "src"), ("iframe", "src")}


class Page(HTMLParser):
    """What one page links to, what it loads, and where it can be linked to."""

    def __init__(self, text: str) -> None:
        """Read it."""
        super().__init__()
        self.links: set[str] = set()
        self.loads: set[str] = set()
        self.anchors: set[str] = set()
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Collect."""
        given = {name: value for name, value in attrs if value}
        self.anchors.update(given[name] for name in ("id", "name") if name in given)
        for name in given.keys() & {"href", "src"}:
            is_loaded = (tag, name) in LOADED or (
                tag == "link" and given.get("rel") in ("stylesheet", "icon")
            )
            (self.loads if is_loaded else self.links).add(given[name])

    def handle_data(self, data: str) -> None:
        """Words."""
        self.text += data


def complaints(site: Path) -> tuple[list[str], set[str]]:
    """What is wrong with the site, and the links that lead out of it."""
    pages = {file.resolve(): Page(file.read_text()) for file in sorted(site.rglob("*.html"))}
    wrong, outside = [], set()
    for file, page in pages.items():
        name = file.relative_to(site.resolve())
        if "$$" in page.text:
            wrong.append(f"{name}: an equation was not read")
        for link in sorted(page.links | page.loads):
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                outside.add(link)
                if link in page.loads and parts.scheme != "data":
                    wrong.append(f"{name}: loads {link}")
                continue
            start = (
                site if parts.path.startswith("/") else file.parent
            )  # the page of a wrong address has the site's root
            target = (
                (start / unquote(parts.path).lstrip("/")).resolve() if parts.path not in ("", ".") else file
            )
            target = target / "index.html" if target.is_dir() else target
            if not target.exists():
                wrong.append(f"{name}: {link} is not there")
            elif parts.fragment and target in pages and not _is_in(unquote(parts.fragment), pages[target]):
                wrong.append(f"{name}: {link} has no such place")
    return wrong, outside


def _is_in(anchor: str, page: Page) -> bool:
    return anchor in page.anchors or anchor.startswith("__")  # what begins so is the theme's
