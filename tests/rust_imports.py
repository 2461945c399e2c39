"""Finds which files of a Rust crate use names that its other files define.

It reads `use` declarations (nested braces, `as`, `pub use` of a `mod.rs`) and paths written out in
the code. Each name is resolved to the file that defines it. Unit tests are left out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

Module = tuple[str, ...]
"""Path of a module from the root of its crate: `("orbit", "kepler")`; the root is `()`."""

USE = re.compile(r"\b(?P<public>pub(?:\s*\([^)]*\))?\s+)?use\s+(?P<tree>[^;]+);")
PATH = re.compile(r"(?<![\w:])[A-Za-z_]\w*(?:::[A-Za-z_]\w*)+")


def without_comments_and_text(source: str) -> str:
    """Returns the source with comments and the contents of string literals removed."""
    comment = r"//[^\n]*|/\*.*?\*/"
    literal = r"""r(#*)".*?"\1|b?"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])'"""
    return re.sub(
        f"{comment}|{literal}", lambda found: "" if found[0].startswith("/") else '""', source, flags=re.S
    )


def end_of_item(text: str, start: int) -> int:
    """Returns the end of the Rust item that begins at `start`: behind its semicolon or closing brace."""
    depth = 0
    for place in range(start, len(text)):
        depth += (text[place] == "{") - (text[place] == "}")
        if depth == 0 and text[place] in ";}":
            return place + 1
    return len(text)


def without_unit_tests(text: str) -> str:
    """Returns the text without the items marked `#[cfg(test)]`."""
    while found := re.search(r"#\[cfg\(test\)\]", text):
        text = text[: found.start()] + text[end_of_item(text, found.end()) :]
    return text


def leaves(tree: str) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yields the paths of a `use` tree and their names: `a::{b, c as d}` gives (a, b) as b, (a, c) as d."""
    tree = tree.strip()
    if "{" not in tree:
        path, _, alias = tree.partition(" as ")
        names = tuple(part.strip() for part in path.split("::") if part.strip())
        if names:
            names = names[:-1] if names[-1] == "self" and len(names) > 1 else names
            yield names, alias.strip() or names[-1]
        return
    head, _, group = tree.partition("{")
    prefix = tuple(part.strip() for part in head.split("::") if part.strip())
    depth, member = 0, ""
    for char in group.rstrip().removesuffix("}") + ",":
        depth += (char == "{") - (char == "}")
        if char == "," and depth == 0:
            for names, alias in leaves(member) if member.strip() else ():
                if names == ("self",):
                    yield prefix, prefix[-1] if alias == "self" else alias
                else:
                    yield (*prefix, *names), alias
            member = ""
        else:
            member += char


class Crate:
    """The modules of one crate below `root`, its `src` folder."""

    def __init__(self, root: Path) -> None:
        self.root = root
        files = (file for file in sorted(root.rglob("*.rs")) if not file.stem.endswith("tests"))
        self.files = {self.module(file): file for file in files}
        self.text = {
            module: without_unit_tests(without_comments_and_text(file.read_text()))
            for module, file in self.files.items()
        }
        self.imports = {module: dict(self.read_imports(text)) for module, text in self.text.items()}

    def module(self, file: Path) -> Module:
        parts = file.relative_to(self.root).with_suffix("").parts
        return parts[:-1] if parts[-1] in ("mod", "lib", "main") else parts

    @staticmethod
    def read_imports(text: str) -> Iterator[tuple[str, tuple[str, ...]]]:
        for use in USE.finditer(text):
            for path, alias in leaves(use["tree"]):
                if alias != "*":
                    yield alias, path
                elif path[0] in ("crate", "self", "super"):
                    raise ValueError(
                        f"`use {use['tree']}` does not name the items that it imports; list them"
                    )

    def resolve(
        self, module: Module, path: tuple[str, ...], seen: frozenset[object] = frozenset()
    ) -> tuple[Module, bool] | None:
        """Returns the module that defines `path` as written in `module`, and whether `path` is that module.

        Returns None for a path that leads out of the crate.
        """
        if (module, path) in seen:
            return None
        seen |= {(module, path)}
        here, names = module, path
        if names[0] == "crate":
            here, names = (), names[1:]
        elif names[0] == "self":
            names = names[1:]
        while names and names[0] == "super":
            here, names = here[:-1], names[1:]
        while names:
            if (*here, names[0]) in self.text:
                here, names = (*here, names[0]), names[1:]
            elif source := self.imports[here].get(names[0]):
                return self.resolve(here, (*source, *names[1:]), seen)
            else:  # an item of this module, or, where no path leads here, a name from elsewhere
                return None if names == path else (here, False)
        return here, True

    def uses(self, module: Module) -> set[Module]:
        """Returns the modules whose files define the names that `module` uses."""
        code = USE.sub("", self.text[module])
        private = {
            path
            for use in USE.finditer(self.text[module])
            if not use["public"]
            for path, _ in leaves(use["tree"])
        }
        # a name that is exported further counts only where the file itself uses it
        public = {
            path for alias, path in self.imports[module].items() if re.search(rf"(?<!::)\b{alias}\b", code)
        }
        found = {self.resolve(module, path) for path in private | public}
        used = {defining for defining, is_module in filter(None, found) if not is_module}
        # a module is imported for the sake of its members, which the code names with a path
        members = {self.resolve(module, tuple(path[0].split("::"))) for path in PATH.finditer(code)}
        return (used | {defining for defining, _ in filter(None, members)}) - {module}

    def graph(self) -> dict[str, set[str]]:
        """Returns the files that each file uses, as paths below the root."""
        name = {module: str(file.relative_to(self.root)) for module, file in self.files.items()}
        return {name[module]: {name[used] for used in self.uses(module)} for module in self.files}


def circles(graph: dict[str, set[str]]) -> list[tuple[str, ...]]:
    """Returns the groups of files that use each other: strongly connected components of several files."""
    reached = {start: reachable(graph, start) for start in graph}
    groups = {
        tuple(sorted(other for other in reached[start] if start in reached[other]))
        for start in graph
        if start in reached[start]
    }
    return sorted(groups)


def reachable(graph: dict[str, set[str]], start: str) -> set[str]:
    found: set[str] = set()
    waiting = list(graph[start])
    while waiting:
        file = waiting.pop()
        if file not in found:
            found.add(file)
            waiting.extend(graph[file])
    return found
