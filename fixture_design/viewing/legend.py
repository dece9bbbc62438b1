"""The legend, as pages, pictures and the session have it: the layers that are there, and the arrows of stories."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from fixture_design.viewing.markup import Markup, tag
from fixture_design.viewing.palette import MOTION, PUSH
from fixture_design.viewing.scene import Scene, Story

#: What stories add: mark, colour and words.
PUSHES, MOVES = ("arrow", PUSH, "pushes that balance, to scale"), ("arrow", MOTION, "how the part moves")


def story_rows(stories: Iterable[Story]) -> Iterator[tuple[str, str, str]]:
    """Those that some of the stories have."""
    told = list(stories)
    if any("/push/" in thing.path for story in told for thing in story.things):
        yield PUSHES
    if any(story.animation or any(thing.color == MOTION for thing in story.things) for story in told):
        yield MOVES


def picture_rows(scene: Scene, story: Story | None) -> Iterator[tuple[str, str, str]]:
    """Those of what is seen while one story is told."""
    seen = {thing.path for thing in scene.told(story)[0]}
    for layer in scene.layers:
        if any(path.startswith(layer.path + "/") for path in seen):
            yield layer.mark, layer.color, layer.text
    yield from story_rows([] if story is None else [story])


def legend_mark(mark: str, color: str) -> Markup:
    """The mark as a small picture."""
    shapes = {
        "arrow": tag("path", d="M0 7H9V2L18 8L9 14V9H0Z", fill=color),
        "cone": tag("path", d="M1 8L17 2V14Z", fill=color),
        "dot": tag("circle", cx=9, cy=8, r=5, fill=color, stroke="#000"),
    }
    square = tag("rect", x=2, y=3, width=14, height=10, fill=color, stroke="#000")
    return tag("svg", shapes.get(mark, square), width=18, height=16, viewBox="0 0 18 16")
