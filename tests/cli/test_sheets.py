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


def test_a_load_path_is_not_overwritten_by_the_report_of_another(command: Callable, tmp_path: Path) -> None:
    (tmp_path / "path.csv").write_text("x,y,fx,fy\n0,0,1,oops\n")
    stage = "stages: [{name: cut, active: [locator], loads: [cut], require: [holds_loads]}]\n"
    bad = written(tmp_path, "bad", f"{HOLDS}loads: [{{name: cut, path: path.csv}}]\n{stage}")
    ran = command("verify", bad, written(tmp_path, "good", HOLDS), "--report", tmp_path / "path.csv")
    assert ran.code == 2
    assert "is an input" in ran.err
    assert "oops" in (tmp_path / "path.csv").read_text()


def test_a_load_path_that_nobody_uses_need_not_be_there(command: Callable, tmp_path: Path) -> None:
    text = f"{HOLDS}loads: [{{name: cut, path: missing.csv}}]\n"
    ran = command("verify", written(tmp_path, "mine", text), "--report", tmp_path / "out.html")
    assert ran.code == 0
    assert "not there" in (tmp_path / "out.html").read_text()


@pytest.mark.parametrize("out", ["missing/out.html", "."])
def test_a_report_that_cannot_be_written(command: Callable, tmp_path: Path, out: str) -> None:
    ran = command("verify", written(tmp_path, "mine", HOLDS), "--report", tmp_path / out)
    assert ran.code == 2
    assert "all requirements hold" in ran.out
    assert ran.err.count("\n") == 1


def test_without_layouts_to_show_nothing_is_written(command: Callable, tmp_path: Path) -> None:
    assert command("verify", written(tmp_path, "bad", BAD), "--report", tmp_path / "out.html").code == 2
    assert not (tmp_path / "out.html").exists()
