"""Checks the built site: every internal link has a target, and no page loads files from other sites."""

from __future__ import annotations

from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

SITE = Path("out/docs")  # where the website is built

LOADED = {("script", "src"), ("img", "src"), ("iframe", "src")}


class Page(HTMLParser):
    """Links and anchors of one page, the files that it loads, and its text."""

    def __init__(self, text: str) -> None:
        """Parses the page."""
        super().__init__()
        self.links: set[str] = set()
        self.loads: set[str] = set()
        self.anchors: set[str] = set()
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Collects anchors, links and loaded files."""
        given = {name: value for name, value in attrs if value}
        self.anchors.update(given[name] for name in ("id", "name") if name in given)
        for name in given.keys() & {"href", "src"}:
            is_loaded = (tag, name) in LOADED or (
                tag == "link" and given.get("rel") in ("stylesheet", "icon")
            )
            (self.loads if is_loaded else self.links).add(given[name])

    def handle_data(self, data: str) -> None:
        """Collects the text of the page."""
        self.text += data


def problems(site: Path) -> tuple[list[str], set[str]]:
    """Returns the problems of the site, one line each, and the external links, which are not checked."""
    pages = {file.resolve(): Page(file.read_text()) for file in sorted(site.rglob("*.html"))}
    wrong, outside = [], set()
    for file, page in pages.items():
        name = file.relative_to(site.resolve())
        if "$$" in page.text:
            wrong.append(f"{name}: an equation was not converted; write each $$ on a separate line")
        for link in sorted(page.links | page.loads):
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                outside.add(link)
                if link in page.loads and parts.scheme != "data":
                    wrong.append(f"{name}: the page loads {link} from another site; use a file of this site")
                continue
            # the error page uses links relative to the root of the site
            start = site if parts.path.startswith("/") else file.parent
            target = (
                (start / unquote(parts.path).lstrip("/")).resolve() if parts.path not in ("", ".") else file
            )
            target = target / "index.html" if target.is_dir() else target
            if not target.exists():
                wrong.append(f"{name}: the target of the link {link} does not exist; correct the link")
            elif parts.fragment and target in pages and not _is_in(unquote(parts.fragment), pages[target]):
                wrong.append(f"{name}: the anchor of the link {link} does not exist; correct the link")
    return wrong, outside


def _is_in(anchor: str, page: Page) -> bool:
    return anchor in page.anchors or anchor.startswith("__")  # anchors of the theme
