"""The sheet to sign: it says what the verdict says, escapes what files say, and overwrites no input."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime
from hashlib import sha256
from html.parser import HTMLParser
from pathlib import Path

import pytest

from fixture_design import read_layout, verify
from fixture_design.errors import FileFormatError
from fixture_design.layout import Layout
from fixture_design.viewing import write_report

BRACKET = Path(__file__).resolve().parents[2] / "urdf" / "bracket" / "bracket.layout.yaml"
NOON = datetime(2026, 1, 2, 12, 0, tzinfo=UTC)


class Text(HTMLParser):
    """The words of a page, and whether every element that was opened is closed."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.words: list[str] = []
        self.open: list[str] = []
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: object) -> None:
        if tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)


def page_of(layout: Layout, path: Path) -> Text:
    write_report([(layout, verify(layout))], path, NOON)
    text = Text(path.read_text())
    assert text.open == []
    return text


def test_what_a_designer_signs(tmp_path: Path) -> None:
    words = page_of(read_layout(BRACKET), tmp_path / "sheet.html").words
    everything = "\n".join(words)
    for said in ("bracket", "2026-01-02 12:00 UTC", "Signed", "all requirements hold", "(54, 6, 0)", "(0, 0, -1)"):
        assert said in everything
    assert "weighs 0.103605 kg" in everything
    assert "20 um" in everything
    assert sha256(BRACKET.read_bytes()).hexdigest() in words
    assert sha256((BRACKET.parent / "bracket.obj").read_bytes()).hexdigest() in words


def test_names_are_escaped(tmp_path: Path) -> None:
    layout = read_layout(BRACKET)
    elements = (replace(layout.elements[0], name="<script>alert(1)</script>"), *layout.elements[1:])
    path = tmp_path / "sheet.html"
    assert "<script>alert(1)</script>" in page_of(replace(layout, elements=elements), path).words
    assert "<script" not in path.read_text()


def test_contacts_alone_have_a_sheet_too(tmp_path: Path) -> None:
    figure = BRACKET.parents[1] / "figure8" / "p12345.layout.yaml"
    assert "in the plane" in "".join(page_of(read_layout(figure), tmp_path / "sheet.html").words)


@pytest.mark.parametrize("name", ["bracket.urdf", "bracket.obj", "copy.layout.yaml"])
def test_inputs_are_not_overwritten(tmp_path: Path, name: str) -> None:
    for file in ("bracket.urdf", "bracket.obj"):
        (tmp_path / file).write_bytes((BRACKET.parent / file).read_bytes())
    (tmp_path / "copy.layout.yaml").write_bytes(BRACKET.read_bytes())
    layout = read_layout(tmp_path / "copy.layout.yaml")
    before = (tmp_path / name).read_bytes()
    with pytest.raises(FileFormatError, match="is an input"):
        write_report([(layout, verify(layout))], tmp_path / name)
    assert (tmp_path / name).read_bytes() == before
