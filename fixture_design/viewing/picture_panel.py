"""The side of a picture: name, verdict by group, what is shown, and the legend."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from fixture_design.viewing.palette import ANSWER_COLORS, ANSWER_SIGNS, MOTION, PUSH
from fixture_design.viewing.scene import Scene, Story
from fixture_design.viewing.summary import SUMMARY

#: Space around the panel, sizes of letters, and what is left between lines [pixels].
_ROOM, _TITLE, _TEXT, _SMALL, _LINE = 16, 20, 14, 12, 5
_INK, _DIM, _BACK, _RULE = "#1c1f23", "#5b626b", "#f6f7f8", "#d5d8dc"


@cache
def font(size: int, bold: bool = False) -> Any:
    """DejaVu Sans, which matplotlib brings along: pictures look alike everywhere."""
    import matplotlib  # noqa: PLC0415 - only where a picture is made
    from PIL import ImageFont  # noqa: PLC0415 - as above

    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name), size)


def draw_panel(draw: Any, scene: Scene, told: Story | None, box: tuple[int, int, int, int]) -> None:
    """Fills the rectangle ``box`` (left, top, right, bottom) of a picture; what does not fit is counted."""
    left, top, right, bottom = box
    draw.rectangle(box, fill=_BACK)
    draw.line([(left, top), (left, bottom)], fill=_RULE)
    width = right - left - 2 * _ROOM
    below = bottom - _legend_height(scene) - _ROOM
    y = _paragraph(draw, left + _ROOM, top + _ROOM, scene.name, font(_TITLE, True), _INK, width, 2)
    summary = f"{ANSWER_SIGNS[scene.satisfied]} {SUMMARY[scene.satisfied]}"
    y = _paragraph(draw, left + _ROOM, y + 2, summary, font(_TEXT, True), ANSWER_COLORS[scene.satisfied], width, 1)
    _stories(draw, scene, told, (left + _ROOM, y + 4, width, below))
    _legend(draw, scene, left + _ROOM, below, width)


def _stories(draw: Any, scene: Scene, told: Story | None, place: tuple[int, int, int, int]) -> None:
    """Groups with their answers, the one that is told with its words, as many as there is room for."""
    left, y, width, below = place
    told_height = _told_height(draw, told, width)
    group = None
    rows = list(scene.stories)
    for number, story in enumerate(rows):
        need = _TEXT + _LINE + (_TEXT + 2 * _LINE if story.group != group else 0)
        reserve = 0 if told is None or any(story is told for story in rows[:number]) else told_height
        if y + need + reserve + _SMALL + _LINE > below:
            draw.text((left, y), f"... {len(rows) - number} more answers", font=font(_SMALL), fill=_DIM)
            y += _SMALL + _LINE
            if told is not None and not any(story is told for story in rows[:number]):
                _answer(draw, told, left, y, width, told=True)
            return
        if story.group != group:
            group = story.group
            draw.text((left, y + _LINE), group, font=font(_TEXT, True), fill=_INK)
            y += _TEXT + 2 * _LINE
        y = _answer(draw, story, left, y, width, told=story is told)


def _told_height(draw: Any, told: Story | None, width: int) -> int:
    if told is None:
        return 0
    lines = sum(len(_wrapped(draw, text, font(_SMALL), width - 12)) for text in (told.words, told.caption) if text)
    return (lines + 1) * (_SMALL + _LINE - 1) + _TEXT + _LINE


def _answer(draw: Any, story: Story, left: int, y: int, width: int, *, told: bool) -> int:
    """One line; with the words and the caption below where it is told."""
    letters = font(_TEXT, told)
    if told:
        draw.rectangle((left - 8, y - 1, left - 5, y + _told_height(draw, story, width) - _LINE), fill=MOTION)
    draw.text((left, y), ANSWER_SIGNS[story.answer], font=font(_TEXT, True), fill=ANSWER_COLORS[story.answer])
    asked = " (required)" if story.required else ""
    said = "no contacts" if story.answer is None else str(story.answer)
    draw.text((left + 20, y), f"{story.claim.replace('_', ' ')}: {said}{asked}", font=letters, fill=_INK)
    y += _TEXT + _LINE
    if told:
        for text in (story.words, story.caption):
            if text:
                y = _paragraph(draw, left + 12, y, text, font(_SMALL), _DIM, width - 12, 8)
    return y


def _legend_height(scene: Scene) -> int:
    return (len(scene.layers) + 3) * (_SMALL + _LINE) + _LINE


def _legend(draw: Any, scene: Scene, left: int, y: int, width: int) -> None:
    """A mark and a word for every layer, and what the arrows of stories are."""
    draw.line([(left, y), (left + width, y)], fill=_RULE)
    y += 2 * _LINE
    for mark, color, text in legend_rows(scene):
        _mark(draw, mark, color, left, y)
        draw.text((left + 24, y - 1), text, font=font(_SMALL), fill=_INK)
        y += _SMALL + _LINE


def legend_rows(scene: Scene) -> Iterator[tuple[str, str, str]]:
    """Mark, colour and words of the legend."""
    yield from ((layer.mark, layer.color, layer.text) for layer in scene.layers)
    yield "arrow", PUSH, "pushes that balance, as long as they are large"
    yield "arrow", MOTION, "how the part moves"


def _mark(draw: Any, mark: str, color: str, left: int, y: int) -> None:
    middle = y + _SMALL // 2
    match mark:
        case "arrow":
            draw.line([(left, middle), (left + 12, middle)], fill=color, width=3)
            draw.polygon([(left + 9, middle - 5), (left + 17, middle), (left + 9, middle + 5)], fill=color)
        case "cone":
            draw.polygon([(left, middle), (left + 16, middle - 6), (left + 16, middle + 6)], fill=color)
        case "dot":
            draw.ellipse((left + 4, middle - 4, left + 12, middle + 4), fill=color, outline="#000000")
        case _:
            draw.rectangle((left + 1, middle - 5, left + 15, middle + 5), fill=color, outline="#000000")


def _paragraph(draw: Any, left: int, y: int, text: str, letters: Any, color: str, width: int, most: int) -> int:
    lines = _wrapped(draw, text, letters, width)
    if len(lines) > most:
        lines = [*lines[: most - 1], lines[most - 1] + " ..."]
    for line in lines:
        draw.text((left, y), line, font=letters, fill=color)
        y += int(letters.size) + _LINE - 1
    return y


def _wrapped(draw: Any, text: str, letters: Any, width: int) -> list[str]:
    """Lines that fit; words that do not are cut."""
    lines = [""]
    for word in text.split():
        piece = word
        while draw.textlength(piece, font=letters) > width and len(piece) > 1:
            piece = piece[:-1]
        longer = f"{lines[-1]} {piece}".strip()
        if draw.textlength(longer, font=letters) <= width:
            lines[-1] = longer
        else:
            lines.append(piece)
    return [line for line in lines if line]
