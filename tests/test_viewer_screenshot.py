"""Screenshots without a screen: errors name the cause."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

from onorbit_rs import viewer
from onorbit_rs.cli.show import save_picture
from onorbit_rs.exceptions import NotFoundError, OutputFolderError, ViewerError
from onorbit_rs.viewer import screenshot

LOUD = "import sys; sys.stderr.write('driver: ' + 'x' * 1_000_000 + '\\nno such device\\n'); sys.exit(1)"
PANICS = """import sys, time
time.sleep(0.5)
sys.stderr.write("thread 'main' panicked at 'No glyph for \\"x\\"'\\nfonts.rs:806\\nstack backtrace:\\n 6: f")
sys.exit(101)"""
LASTS = "import time; time.sleep({})"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(screenshot, "SETTLE_S", 0.0)
    (tmp_path / "run.rrd").touch()
    return tmp_path


def viewer_is(monkeypatch: pytest.MonkeyPatch, program: str, refusals: int = 0, image: Any = None) -> None:
    """Replaces the viewer by a program whose client fails to connect a number of times."""
    refused = iter(range(refusals))

    class Client:
        @classmethod
        def connect(cls, url: str) -> Client:
            if next(refused, None) is not None:
                raise ConnectionError("transport error")
            return cls()

        def set_time(self, *_: Any, **__: Any) -> None: ...

        def take_screenshot(self) -> Any:
            if image is None:
                raise ConnectionError("transport error")
            return image

    monkeypatch.setattr(screenshot, "command_of", lambda port: [sys.executable, "-c", program])
    monkeypatch.setattr(screenshot, "ViewerClient", Client)


def test_a_folder_without_a_recording_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(NotFoundError, match="no such recording"):
        viewer.take_screenshot(tmp_path / "run.rrd", tmp_path / "run.png")


def test_a_viewer_with_much_output_before_it_exits_is_read(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its stderr was once an unread pipe: it blocked, and the error said that it had printed nothing."""
    viewer_is(monkeypatch, LOUD, refusals=10**9)
    with pytest.raises(ViewerError, match="did not start: no such device; install a Vulkan driver"):
        viewer.take_screenshot(folder / "run.rrd", folder / "run.png")


def test_a_crashed_viewer_is_distinguished_from_an_unwritable_picture(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer_is(monkeypatch, PANICS)
    with pytest.raises(ViewerError, match=r'display the recording: No glyph for "x"; repeat the run'):
        save_picture(folder, folder / "run.png", 0.0)
    assert not (folder / "run.png").exists()


def test_a_viewer_that_cannot_be_started_is_reported(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(screenshot, "command_of", lambda port: [str(folder / "none")])
    with pytest.raises(ViewerError, match=r"did not start: .*No such file"):
        viewer.take_screenshot(folder / "run.rrd", folder / "run.png")


def test_a_slow_viewer_is_waited_for(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    viewer_is(monkeypatch, LASTS.format(60), refusals=3, image=b"PNG")
    assert viewer.take_screenshot(folder / "run.rrd", folder / "run.png").read_bytes() == b"PNG"
    with pytest.raises(OutputFolderError, match=r"cannot write .*none/run\.png: No such file"):
        viewer.take_screenshot(folder / "run.rrd", folder / "none" / "run.png")
