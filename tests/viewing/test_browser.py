"""The preview in a real browser, without a network: it draws, tells its stories, moves the part, and calls nobody."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import fixture_design as fd
from fixture_design.viewing import preview_page
from tests.viewing.browser import Page, browser
from tests.viewing.test_preview import hostile
from tests.viewing.test_scene import BRACKET, URDF, looked_at

pytestmark = pytest.mark.browser

READY = "window.viewer !== undefined"
#: Pixels that differ by more than this are different [of 255].
SEEN = 12


@pytest.fixture(scope="module")
def chrome() -> Iterator[Page]:
    with browser() as page:
        page.offline()
        yield page


@pytest.fixture(scope="module")
def bracket(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("preview") / "bracket.html"
    path.write_text(preview_page(*looked_at(BRACKET)[:2]))
    return path


def different(first: np.ndarray, second: np.ndarray) -> int:
    """How many pixels are."""
    return int((np.abs(first.astype(int) - second.astype(int)).max(axis=2) > SEEN).sum())


def story(claim: str, group: str) -> int:
    stories = looked_at(BRACKET)[2].stories
    return next(k for k, each in enumerate(stories) if (each.group, each.claim) == (group, claim))


def position(page: Page) -> np.ndarray:
    return np.array(page.run("viewer.scene_tree.find(['scene', 'part']).object.position.toArray()"))


def test_it_draws_without_a_network_and_asks_for_nothing(chrome: Page, bracket: Path) -> None:
    chrome.events.clear()
    chrome.open(bracket.as_uri(), READY)
    canvas = chrome.canvas()
    colors = np.unique(canvas.reshape(-1, 3) // 16, axis=0)
    assert len(colors) > 20
    assert (canvas.min(axis=2) < 230).mean() > 0.1
    assert chrome.requests() == [bracket.as_uri()]
    assert chrome.troubles() == []


def test_the_policy_stops_what_would_call_out(chrome: Page, bracket: Path) -> None:
    chrome.open(bracket.as_uri(), READY)
    assert chrome.run("fetch('data:text/plain,x').then(() => 'loaded', () => 'stopped')") == "stopped"


def test_an_element_that_is_switched_off_is_not_drawn(chrome: Page, bracket: Path) -> None:
    chrome.open(bracket.as_uri(), READY)
    chrome.run("tell(null)")
    before = chrome.canvas()
    layer = [layer.path for layer in looked_at(BRACKET)[2].layers].index("elements/clamp")
    chrome.click(f"#layer-{layer}")
    without = chrome.canvas()
    assert different(before, without) > 1000
    chrome.click(f"#layer-{layer}")
    assert different(before, chrome.canvas()) < 100


def test_a_click_on_an_answer_tells_its_story_and_moves_the_part(chrome: Page, bracket: Path) -> None:
    chrome.open(bracket.as_uri(), READY)
    free = story("form_closure", "locators")
    chrome.click(f"[data-story='{free}']")
    assert chrome.run(f"document.querySelector(\"[data-story='{free}']\").getAttribute('aria-pressed')") == "true"
    assert "smallest push" in chrome.run("document.querySelector('[aria-pressed=true]').innerText")
    chrome.wait("viewer.animator.time > 0.8")
    moved = position(chrome)
    assert np.linalg.norm(moved) > 0.01
    animation = looked_at(BRACKET)[2].stories[free].animation
    assert animation is not None
    wanted = looked_at(BRACKET)[2].matrix(animation.poses[-1])[:3, 3]
    # along the same way, within what the turn bends it
    assert moved @ wanted / np.linalg.norm(moved) / np.linalg.norm(wanted) > 0.95
    chrome.click("#overview")
    assert position(chrome) == pytest.approx(np.zeros(3))


def test_stories_differ_on_the_canvas(chrome: Page, bracket: Path) -> None:
    chrome.open(bracket.as_uri(), READY)
    chrome.run("playing = false")
    pictures = []
    for claim in ("form_closure", "force_closure"):
        chrome.run(f"tell({story(claim, 'all')})")
        pictures.append(chrome.canvas())
    assert different(*pictures) > 300


def test_names_are_written_beside_the_drawing(chrome: Page, bracket: Path) -> None:
    chrome.open(bracket.as_uri(), READY)
    chrome.wait("lastSeen !== ''")
    ink = (
        "Array.from(byId('names').getContext('2d').getImageData(0, 0, byId('names').width, byId('names').height).data)"
    )
    assert chrome.run(f"{ink}.filter((value, k) => k % 4 === 3 && value > 0).length") > 500


def test_hostile_names_do_nothing(chrome: Page, tmp_path: Path) -> None:
    layout = hostile()
    (tmp_path / "x.html").write_text(preview_page(layout, fd.verify(layout)))
    chrome.open((tmp_path / "x.html").as_uri(), READY)
    assert chrome.run("window.stolen === undefined") is True
    assert chrome.run("document.querySelectorAll('img').length") == 0
    assert "<img src=x" in chrome.run("document.querySelector('h1').innerText")


@pytest.mark.parametrize("name", ["polygon_p12345", "p1234"])
def test_planar_layouts_are_drawn(chrome: Page, tmp_path: Path, name: str) -> None:
    layout, verdict, _ = looked_at(URDF / "figure8" / f"{name}.layout.yaml")
    (tmp_path / "x.html").write_text(preview_page(layout, verdict))
    chrome.events.clear()
    chrome.open((tmp_path / "x.html").as_uri(), READY)
    assert (chrome.canvas().min(axis=2) < 230).mean() > 0.02
    assert chrome.troubles() == []
