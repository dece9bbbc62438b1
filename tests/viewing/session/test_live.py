"""The session in a real browser: sliders and buttons are clicked, and what the page says is what `verify` says."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fixture_design as fd
from fixture_design.layout import Layout
from fixture_design.viewing.session import Interactive
from fixture_design.viewing.session.lines import answer_lines, element_line
from fixture_design.viewing.session.panel import ELEMENT, U
from tests.viewing.browser import PATIENCE, Page, browser

pytestmark = pytest.mark.browser

URDF = Path(__file__).resolve().parents[3] / "urdf"
BRACKET = URDF / "bracket" / "bracket.layout.yaml"
POLYGON = URDF / "figure8" / "polygon_p12345.layout.yaml"

TEXTS = "Array.from(document.querySelectorAll('.dg li.function')).map(each => each.textContent)"


@pytest.fixture(scope="module")
def chrome() -> Iterator[Page]:
    with browser() as page:
        yield page


class Session:
    """A session and the page that shows it, with its controls open."""

    def __init__(self, page: Page, thing: Path | Layout, target: Path) -> None:
        self.page, self.target = page, target
        self.live: Interactive = fd.interactive(thing, out=target)
        assert self.live.address is not None
        page.events.clear()
        page.open(self.live.address, f"{TEXTS}.includes('quit')")

    def texts(self) -> list[str]:
        return self.page.run(TEXTS)

    def click(self, text: str) -> None:
        """A real click on the button with this text."""
        self.mark("function", text)
        self.page.click("#wanted")

    def mark(self, kind: str, text: str) -> None:
        rows = f"Array.from(document.querySelectorAll('.dg li.{kind}'))"
        row = f"{rows}.find(each => each.textContent.trim() === {json.dumps(text)})"
        self.page.wait(f"{row} !== undefined")
        self.page.run(f"document.querySelectorAll('#wanted').forEach(e => e.id = ''), {row}.id = 'wanted'")

    def slide(self, slider: str, part: float) -> None:
        """A real click on a slider, at this part of its length."""
        self.mark("has-slider", slider)
        box = self.page.run(
            "(e => { e.scrollIntoView({block: 'center'}); const r = e.getBoundingClientRect();"
            "return [r.x, r.y + r.height / 2, r.width] })(document.querySelector('#wanted .slider'))"
        )
        for kind in ("mousePressed", "mouseReleased"):
            self.page.send(
                "Input.dispatchMouseEvent", type=kind, x=box[0] + part * box[2], y=box[1], button="left", clickCount=1
            )

    def until(self, holds: Callable[[], bool]) -> None:
        end = time.monotonic() + PATIENCE
        while not holds():
            assert time.monotonic() < end, f"it never came; the page says {self.texts()}; {self.live.message}"
            time.sleep(0.05)

    def stays(self, told: tuple[str, str] | None) -> None:
        """For a second what is told stays the same, and nothing is drawn again."""
        time.sleep(0.3)
        version, end = self.live.version, time.monotonic() + 1
        while time.monotonic() < end:
            assert (self.live.told, self.live.version) == (told, version)
            time.sleep(0.005)

    def end(self) -> None:
        """The page first, or it would ask for more."""
        self.page.open("about:blank")
        self.live.stop()

    def says(self, lines: list[str]) -> None:
        self.until(lambda: set(lines) <= set(self.texts()))


@pytest.fixture
def session(chrome: Page, tmp_path: Path) -> Iterator[Session]:
    session = Session(chrome, BRACKET, tmp_path / "bracket.yaml")
    yield session
    session.end()


@pytest.fixture
def planar(chrome: Page, tmp_path: Path) -> Iterator[Session]:
    session = Session(chrome, POLYGON, tmp_path / "polygon.yaml")
    yield session
    session.end()


def answers(layout: Layout) -> list[str]:
    return [line.text for line in answer_lines(fd.verify(layout))]


def test_a_slider_moves_an_element_and_the_page_says_what_verify_says(session: Session) -> None:
    before = answers(session.live.layout)
    session.says(before)
    canvas = session.page.screenshot()
    start = session.live.layout.elements[0].at
    session.slide(U, 0.45)
    session.until(lambda: not np.array_equal(session.live.layout.elements[0].at, start))
    session.click("save")
    session.until(lambda: not session.live.session.unsaved)
    saved = fd.read_layout(session.target)
    moved = saved.elements[0].at - start
    assert 1e-3 < np.linalg.norm(moved) < 0.02
    assert abs(moved[2]) < 1e-9  # under the base it stays there
    after = answers(saved)
    assert after != before
    session.says(after)
    assert not set(before) - set(after) & set(session.texts())
    assert (np.abs(session.page.screenshot().astype(int) - canvas) > 12).any(axis=2).sum() > 200
    assert session.page.troubles() == []


def test_add_remove_undo_and_save_by_clicks(session: Session) -> None:
    first = session.live.layout
    session.click("add at the best place")
    session.until(lambda: len(session.live.layout.elements) == len(first.elements) + 1)
    new = session.live.layout.elements[-1]
    session.says([f"{new.name}: clamp, point", *answers(session.live.layout)])
    session.click("undo")
    session.says([element_line(first.elements[-1]).text])
    assert session.live.layout is first
    session.slide(ELEMENT, 0.01)
    session.until(lambda: session.live.session.chosen == first.elements[0].name)
    session.slide(ELEMENT, 0.99)
    session.until(lambda: session.live.session.chosen == first.elements[-1].name)
    session.click("remove")
    session.until(lambda: len(session.live.layout.elements) == len(first.elements) - 1)
    session.says(answers(session.live.layout))
    session.click("save")
    session.until(session.target.exists)
    assert answers(fd.read_layout(session.target)) == answers(session.live.layout)
    session.click("undo")
    session.until(lambda: session.live.layout is first)
    session.click("redo")
    session.until(lambda: len(session.live.layout.elements) == len(first.elements) - 1)
    assert session.page.troubles() == []


def test_a_change_of_the_answer_is_read_in_the_page(planar: Session) -> None:
    planar.says(answers(planar.live.layout))
    planar.click("remove")
    planar.click("remove")
    planar.until(lambda: len(planar.live.layout.elements) == 3)
    planar.says(answers(planar.live.layout))
    assert any(text.startswith("✗ all: form_closure: no") for text in planar.texts())
    planar.click("make valid")
    planar.until(lambda: any(text.startswith("✓ all: form_closure: yes") for text in planar.texts()))
    planar.says(answers(planar.live.layout))


def test_a_click_on_an_answer_shows_what_it_rests_on(session: Session) -> None:
    line = next(text for text in answers(session.live.layout) if "locators: form_closure" in text)
    session.click(line)
    session.until(lambda: session.live.told == ("locators", "form_closure"))
    session.until(lambda: any("can move" in text for text in session.texts()))
    session.stays(("locators", "form_closure"))
    session.click(element_line(session.live.layout.elements[0]).text)
    session.stays(("locators", "form_closure"))
    session.click(line)
    session.until(lambda: session.live.told is None)
    session.stays(None)


def test_scene_and_verdict_are_seen_together(session: Session) -> None:
    """The page does not scroll, the controls do; names are there, the legend, and what was said last."""
    page = session.page
    session.click(session.texts()[-1])  # the last line, which is scrolled to
    assert page.run("document.documentElement.scrollHeight <= innerHeight && scrollX === 0 && scrollY === 0")
    box = page.run(
        "(r => [r.top, r.left, r.width])(document.querySelector('#meshcat-pane canvas').getBoundingClientRect())"
    )
    assert box[0] == page.run("document.querySelector('#said').offsetHeight")  # which does not cover it
    assert box[1] == 0
    assert box[2] < page.run("innerWidth") - page.run("document.querySelector('#panel').offsetWidth") + 1
    names = {label["text"] for label in page.run("texts()")}
    assert {element.name for element in session.live.layout.elements} <= names
    legend = page.run("document.querySelector('.legend').textContent")
    assert "locator" in legend
    assert "pushes that balance" in legend
    session.live.remove()
    session.live.save()
    session.until(lambda: page.run("document.querySelector('#said').textContent").startswith("saved "))


def test_quit_in_the_page_leaves_a_recovery_file(chrome: Page, tmp_path: Path) -> None:
    session = Session(chrome, POLYGON, tmp_path / "polygon.yaml")
    session.click("remove")
    session.until(lambda: len(session.live.layout.elements) == 4)
    session.click("quit")
    session.until((tmp_path / "polygon.recovered.yaml").exists)
    assert len(fd.read_layout(tmp_path / "polygon.recovered.yaml").elements) == 4
    session.end()
    assert not session.target.exists()


def test_names_from_files_are_no_code(chrome: Page, tmp_path: Path) -> None:
    layout = fd.read_layout(POLYGON)
    names = ["'});window.stolen=1;({a:'", "<img src=x onerror='window.stolen=1'>", "\\u0027+alert(1)//`${1}`"]
    elements = (*(replace(e, name=n) for e, n in zip(layout.elements, names, strict=False)), *layout.elements[3:])
    session = Session(chrome, replace(layout, elements=elements), tmp_path / "x.yaml")
    for number in range(len(names)):
        session.live.choose(number + 1)
        session.live.tell(None)
        session.until(lambda: any(text.endswith("locator, point") for text in session.texts()))
    assert chrome.run("window.stolen === undefined") is True
    assert chrome.run("document.querySelectorAll('.dg img').length") == 0
    assert chrome.troubles() == []
    session.end()
