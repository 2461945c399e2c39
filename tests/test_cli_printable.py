"""Untrusted names are printed without control characters and in every encoding."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import unicodedata
from pathlib import Path

import pytest
import yaml
from commands import SPIN, onorbit, refusal
from test_cli_summary import PLAIN
from test_cli_terminal import on_terminal

import onorbit_rs as oo
from onorbit_rs import robots, scenarios
from onorbit_rs.cli.list import descriptions
from onorbit_rs.common.printable import printable, shell_word
from onorbit_rs.scenario import load

EVIL = "a\x1b[31m\u202eb\nc\x9b\u2028"
SAFE = "a\\x1b[31m\\u202eb\\nc\\x9b\\u2028"


def steers(text: str) -> set[str]:
    """Returns control and bidirectional characters, except line ends."""
    kinds = ("Cc", "Cf", "Zl", "Zp", "Cs")
    return {char for char in text if unicodedata.category(char) in kinds and char != "\n"}


def test_only_control_characters_are_escaped() -> None:
    assert steers(EVIL) and printable(EVIL) == SAFE
    assert printable("Küche 机器人 µ² ≤") == "Küche 机器人 µ² ≤"


@pytest.mark.skipif(os.name != "posix", reason="the test uses a POSIX shell")
@pytest.mark.parametrize("word", ["plain", "two words", "it's", EVIL, "a\\b\n'", "\udcff\t", "$x `y` \n"])
def test_a_shell_reads_a_quoted_word_back(word: str) -> None:
    said = shell_word(word)
    assert not steers(said) and "\n" not in said
    done = subprocess.run(["bash", "-c", f"printf %s {said}"], capture_output=True, check=True, timeout=60)
    assert done.stdout == os.fsencode(word)


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.skipif(os.name != "posix", reason="only on POSIX may file names contain any character")
def test_no_command_prints_control_characters_of_a_name(tmp_path: Path) -> None:
    (tmp_path / f"{EVIL}.yaml").write_text(SPIN.replace("name: spin", f"name: {json.dumps(EVIL)}"))
    (tmp_path / f"{EVIL}.urdf").write_text(PLAIN.format(name="x\u202ey"))
    (tmp_path / "note.yaml").write_text("Nothing")
    runs = (
        ("check", f"{EVIL}.yaml"),
        ("run", f"{EVIL}.yaml", "--out", EVIL),
        ("show", EVIL, "--no-viewer"),
        ("show", EVIL),
        ("show", EVIL, "--json"),
        ("report", EVIL, "--no-pdf"),
        ("compare", EVIL, f"{EVIL}.yaml"),
        ("info", f"{EVIL}.urdf"),
        ("info", f"{EVIL}.urdf", "--json"),
        ("new", f"{EVIL}.urdf", "--out", f"{EVIL}.new"),
        ("run", f"no{EVIL}.yaml"),
        ("show", f"no{EVIL}"),
        ("run", f"{EVIL}.yaml", "--out", EVIL),
        ("info", f"no{EVIL}.urdf"),
        (f"no{EVIL}",),
        ("run", f"--no{EVIL}"),
    )
    for words in runs:
        done = onorbit(*words, cwd=tmp_path)
        said = done.stdout + done.stderr
        assert done.returncode in (0, 2) and said and not steers(said), (words, done)
        assert "\\u202e" in said or "\\xe2\\x80\\xae" in said, (words, done)
    assert json.loads(onorbit("show", EVIL, "--json", cwd=tmp_path).stdout)["scenario"] == EVIL
    assert refusal("show", f"no{EVIL}", cwd=tmp_path).endswith(
        ": no such folder; give the output folder of a run"
    )


def test_a_comparison_printed_from_python_escapes_control_characters() -> None:
    scenario = yaml.safe_load(SPIN) | {"name": EVIL}
    said = str(oo.compare(scenario, scenario))
    assert said.startswith(f"{SAFE} ") and not steers(said)


def test_the_progress_bar_escapes_control_characters(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(SPIN.replace("name: spin", 'name: "x\\u202ey"'))
    code, written = on_terminal("run", "mine.yaml", cwd=tmp_path)
    assert code == 0 and "x\\u202ey" in written and "\u202e" not in written


@pytest.mark.parametrize(
    "settings",
    [{"PYTHONIOENCODING": "ascii"}, {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}],
    ids=["PYTHONIOENCODING", "LC_ALL"],
)
def test_characters_missing_from_an_encoding_are_replaced(settings: dict[str, str], tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(SPIN.replace("spin", "Küche"), encoding="utf-8")
    for words, expected in (
        (("info", "ets_vii"), "kg m^2"),
        (("validate", "--list", "--only", "hill"), "<= "),
        (("check", "mine.yaml"), "ok: K\\xfcche: "),
        (("check", "mine.yaml", "--json"), '"scenario": "K\\u00fcche"'),
        (("check", "Küche.yaml"), "cche.yaml'"),  # its bytes are invalid in the C locale
    ):
        done = subprocess.run(
            [sys.executable, "-m", "onorbit_rs", *words], capture_output=True, cwd=tmp_path, timeout=60,
            env=os.environ | settings, check=False,
        )  # fmt: skip
        said = (done.stdout + done.stderr).decode("ascii")
        assert expected in said and "Traceback" not in said, (words, said)


NARROW = 40


@pytest.mark.parametrize(
    "words", [("info", "ets_vii"), ("list",), ("run", "dual_arm_reach"), ("run", "--help")]
)
def test_a_narrow_terminal_cuts_neither_names_nor_numbers(words: tuple[str, ...], tmp_path: Path) -> None:
    _, written = on_terminal(*words, cwd=tmp_path, COLUMNS=str(NARROW), NO_COLOR="1")
    wanted = {
        "info": ["2552", "3.58e+03 6.21e+03 7.09e+03", "joint_6"],
        "list": [name for name in scenarios.names() if len(name) < NARROW],
        "run": ["--checkpoint-every"] if "--help" in words else ["relative", "holds"],
    }
    settled = written.split("\x1b[?25h")[-1]  # after the bar
    for text in wanted[words[0]]:
        assert text in settled, written
    assert "…" not in settled


def test_the_list_shows_the_descriptions_of_the_scenarios() -> None:
    shown = descriptions(scenarios.SCENARIOS)
    assert shown == {name: load(name).description.strip() for name in scenarios.names()}
    assert robots.names()


@pytest.mark.skipif(os.name != "posix", reason="the test closes POSIX pipes")
def test_a_closed_pipe_is_not_an_error(tmp_path: Path) -> None:
    coarse = load("free_tumble").resolved()
    coarse["simulation"] |= {"duration": 10.0, "time_step": 0.1}
    (tmp_path / "coarse.yaml").write_text(json.dumps(coarse))
    for words, code in (
        (("list",), 0),
        (("list", "--json"), 0),
        (("run", "coarse.yaml"), 1),  # its certificate fails, whether the output is read or not
    ):
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run(
            [sys.executable, "-m", "onorbit_rs", *words], stdout=writer, stderr=subprocess.PIPE, cwd=tmp_path,
            timeout=60, check=False,
        )  # fmt: skip
        os.close(writer)
        assert done.returncode == code and b"Traceback" not in done.stderr, (words, done)
