"""`verify --report`: one file of sheets; the verdict is said whatever becomes of the file."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.layouts import BAD, FAILS, HOLDS


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / f"{name}.yaml"
    path.write_text(text)
    return path


def test_sheets_of_all_that_could_be_verified(command: Callable, tmp_path: Path) -> None:
    paths = [written(tmp_path, name, text) for name, text in (("good", HOLDS), ("bad", BAD), ("fails", FAILS))]
    ran = command("verify", *paths, "--report", tmp_path / "out.html")
    page = (tmp_path / "out.html").read_text()
    assert ran.code == 2
    assert "<h1>good</h1>" in page
    assert "<h1>fails</h1>" in page
    assert "<h1>bad</h1>" not in page


def test_a_layout_is_not_overwritten(command: Callable, tmp_path: Path) -> None:
    path = written(tmp_path, "mine", HOLDS)
    for out in (path, tmp_path / "." / "mine.yaml"):
        ran = command("verify", path, "--report", out)
        assert ran.code == 2
        assert "is an input" in ran.err
        assert path.read_text() == HOLDS


@pytest.mark.parametrize("out", ["missing/out.html", "."])
def test_a_report_that_cannot_be_written(command: Callable, tmp_path: Path, out: str) -> None:
    ran = command("verify", written(tmp_path, "mine", HOLDS), "--report", tmp_path / out)
    assert ran.code == 2
    assert "all requirements hold" in ran.out
    assert ran.err.count("\n") == 1


def test_without_layouts_to_show_nothing_is_written(command: Callable, tmp_path: Path) -> None:
    assert command("verify", written(tmp_path, "bad", BAD), "--report", tmp_path / "out.html").code == 2
    assert not (tmp_path / "out.html").exists()
