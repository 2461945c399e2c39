"""Checks that names and phrases which only this project used do not come back."""

from __future__ import annotations

import re
import subprocess
import tomllib
from functools import cache
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[1]

WORDS = tomllib.loads((REPOSITORY / "tests" / "replaced_words.toml").read_text())
SPACE = r"[\s#/!]+"  # a phrase may continue on the next line of a comment

PATTERNS = {
    "file_names": {word: re.compile(rf"(?:.*/)?{word}\.(?:rs|py)") for word in WORDS["file_names"]},
    "identifiers": {word: re.compile(rf"\b{word}\b") for word in WORDS["identifiers"]},
    "phrases": {
        phrase: re.compile(rf"(?<![\w-]){SPACE.join(phrase.split())}(?![\w-])", re.IGNORECASE)
        for phrase in WORDS["phrases"]
    },
}


@cache
def tracked_files() -> dict[str, str]:
    """Returns the text of each source file and page, except this test, recorded data and past changes."""
    listed = subprocess.run(["git", "ls-files"], cwd=REPOSITORY, capture_output=True, text=True, check=True)
    names = [
        name
        for name in listed.stdout.splitlines()
        if name.endswith((".rs", ".py", ".pyi", ".hpp", ".cpp", ".md", ".yaml", ".toml", "Makefile"))
        and not name.startswith(
            ("tests/fixtures/", "CHANGELOG.md", "tests/test_wording.py", "tests/replaced_words.toml")
        )
        and (REPOSITORY / name).is_file()
    ]
    assert len(names) > 500
    return {name: (REPOSITORY / name).read_text() for name in names}


@cache
def code(text: str) -> str:
    """Returns Rust or Python code without comments and string literals."""
    comment = r"//[^\n]*|(?<!\w)#(?![\[!])[^\n]*"
    literal = r'"""(?:.|\n)*?"""|r(#*)"(?:.|\n)*?"\1|"(?:\\(?:.|\n)|[^"\\])*"'
    return re.sub(f"{literal}|{comment}", "", text)


def places(kind: str, word: str, files: dict[str, str]) -> list[str]:
    """Returns where a word occurs: the file and, inside a file, the text around it."""
    pattern = PATTERNS[kind][word]
    if kind == "file_names":
        return [name for name in files if pattern.fullmatch(name)]
    found = []
    for name, text in files.items():
        if kind == "identifiers":
            text = code(text) if name.endswith((".rs", ".py", ".pyi")) else ""
        for match in pattern.finditer(text):
            around = text[max(match.start() - 40, 0) : match.end() + 30]
            found.append(f"{name}: {' '.join(around.split())}")
    return found


@pytest.mark.parametrize(
    ("kind", "word"),
    [(kind, word) for kind, words in PATTERNS.items() for word in words if word not in WORDS["not_yet"]],
)
def test_a_word_that_was_replaced_does_not_come_back(kind: str, word: str) -> None:
    assert not places(kind, word, tracked_files())


@pytest.mark.parametrize(
    ("kind", "word", "name", "text"),
    [
        ("file_names", "walk", "crates/core/src/dynamics/walk.rs", ""),
        ("file_names", "doubts", "python/onorbit_rs/doubts.py", ""),
        ("identifiers", "settle", "a.rs", "/// Projects.\nfn settle(&mut self) {}"),
        ("identifiers", "told", "a.py", 'told = "said"  # what'),
        ("phrases", "of its own", "a.rs", "/// a reference of its\n    /// own from there"),
        ("phrases", "of ours", "docs/a.md", "an engine\nof ours"),
        ("phrases", "is told", "a.py", '"""What is told."""'),
    ],
)
def test_the_search_finds_each_kind_of_word(kind: str, word: str, name: str, text: str) -> None:
    assert len(places(kind, word, {"before.rs": "", name: text})) == 1


@pytest.mark.parametrize(
    ("kind", "word", "name", "text"),
    [
        ("file_names", "walk", "crates/core/src/sidewalk.rs", ""),
        ("identifiers", "settle", "a.rs", 'fn settled() { f("settle") } // settle'),
        ("identifiers", "told", "a.py", '"""He told."""\nuntold = 1'),
        ("phrases", "of its own", "a.md", "of its owner"),
    ],
)
def test_the_search_ignores_other_words(kind: str, word: str, name: str, text: str) -> None:
    assert places(kind, word, {name: text}) == []
