"""The side of a picture: name, verdict by group, what is shown, and the legend."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from fixture_design.viewing.legend import picture_rows
from fixture_design.viewing.palette import ANSWER_COLORS, ANSWER_SIGNS, MOTION, answer_color, answer_sign
from fixture_design.viewing.scene import Scene, Story
from fixture_design.viewing.summary import SUMMARY

#: Space around the panel, sizes of letters, and what is left between lines [pixels of a picture of usual size].
_ROOM, _TITLE, _TEXT, _SMALL, _LINE = 16.0, 20.0, 14.0, 12.0, 5.0
#: Lines of words and of the caption that are shown at most.
_MOST_LINES = 8
_INK, _DIM, _BACK, _RULE = "#1c1f23", "#5b626b", "#f6f7f8", "#d5d8dc"


@cache
def font(size: float, bold: bool = False) -> Any:
    """DejaVu Sans, which matplotlib brings along: pictures look alike everywhere."""
    import matplotlib  # noqa: PLC0415 - only where a picture is made
    from PIL import ImageFont  # noqa: PLC0415 - as above

    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name), size)


def draw_panel(draw: Any, scene: Scene, told: Story | None, box: tuple[int, int, int, int], scale: float) -> None:
    """Fills the rectangle ``box`` (left, top, right, bottom) of a picture; answers that do not fit are counted.

    Args:
        scale: of letters, 1 in a picture of usual size.
    """
    left, top, right, bottom = box
    draw.rectangle(box, fill=_BACK)
    draw.line([(left, top), (left, bottom)], fill=_RULE)
    pen = _Pen(draw, left + _ROOM * scale, right - left - 2 * _ROOM * scale, scale, top + _ROOM * scale)
    rows = list(picture_rows(scene, told))
    below = bottom - (len(rows) + 1.5) * pen.step(_SMALL)
    pen.words(scene.name, _TITLE, _INK, bold=True, most=2)
    pen.words(
        f"{ANSWER_SIGNS[scene.satisfied]} {SUMMARY[scene.satisfied]}", _TEXT, ANSWER_COLORS[scene.satisfied], bold=True
    )
    _answers(pen, scene.stories, told, below)
    pen.y = below
    draw.line([(pen.left, below), (pen.left + pen.width, below)], fill=_RULE)
    pen.y += _LINE * scale
    for mark, color, text in rows:
        _mark(pen, mark, color)
        pen.words(text, _SMALL, _INK, indent=24.0, most=1)


@dataclass
class _Pen:
    """Writes lines one below the other; ``y`` is where the next one goes."""

    draw: Any
    left: float
    width: float
    scale: float
    y: float

    def step(self, size: float) -> float:
        """Height of a line of letters."""
        return (size + _LINE) * self.scale

    def lines(self, text: str, size: float, bold: bool, indent: float, most: int) -> list[str]:
        """Lines that fit, at most so many; the last one says that it goes on."""
        letters, width = font(size * self.scale, bold), self.width - indent * self.scale
        lines = [""]
        for word in text.split():
            longer = f"{lines[-1]} {word}".strip()
            if lines[-1] and self.draw.textlength(longer, font=letters) > width:
                lines.append(word)
            else:
                lines[-1] = longer
        cut = [*lines[: most - 1], " ".join(lines[most - 1 :])] if len(lines) > most else lines
        return [self._cut(line, letters, width) for line in cut]

    def _cut(self, line: str, letters: Any, width: float) -> str:
        if self.draw.textlength(line, font=letters) <= width:
            return line
        while line and self.draw.textlength(line + "…", font=letters) > width:
            line = line[:-1]
        return line.rstrip() + "…"

    def words(
        self, text: str, size: float, color: str, *, bold: bool = False, indent: float = 0.0, most: int = 1
    ) -> None:  # fmt: skip
        for line in self.lines(text, size, bold, indent, most):
            place = (self.left + indent * self.scale, self.y)
            self.draw.text(place, line, font=font(size * self.scale, bold), fill=color)
            self.y += self.step(size)


def _answers(pen: _Pen, stories: tuple[Story, ...], told: Story | None, below: float) -> None:
    """Groups with their answers, the one that is told with its words; of the others as many as there is room for."""
    group, left_out = None, 0
    for number, story in enumerate(stories):
        heading = 0.0 if story.group == group else pen.step(_TEXT) + _LINE * pen.scale
        comes = told is not None and not any(each is told for each in stories[: number + 1])
        kept = (_height(pen, told) if comes and told is not None else 0.0) + pen.step(_SMALL)
        if story is not told and pen.y + heading + pen.step(_TEXT) + kept > below:
            left_out += 1
            continue
        if heading:
            pen.y += _LINE * pen.scale
            pen.words(story.group, _TEXT, _INK, bold=True)
            group = story.group
        _answer(pen, story, told=story is told)
    if left_out:
        pen.words(f"… {left_out} more answers", _SMALL, _DIM)


def _height(pen: _Pen, told: Story) -> float:
    """What the answer that is told needs, with its group's name."""
    lines = sum(len(pen.lines(text, _SMALL, False, 12.0, _MOST_LINES)) for text in (told.words, told.caption) if text)
    return lines * pen.step(_SMALL) + 2 * pen.step(_TEXT) + _LINE * pen.scale


def _answer(pen: _Pen, story: Story, *, told: bool) -> None:
    """One line; with the words and the caption below where it is told."""
    top = pen.y
    sign = font(_TEXT * pen.scale, True)
    mark, color = answer_sign(story.answer, story.required), answer_color(story.answer, story.required)
    pen.draw.text((pen.left, top), mark, font=sign, fill=color)
    said = "no contacts" if story.answer is None else str(story.answer)
    asked = " (required)" if story.required else ""
    pen.words(f"{story.claim.replace('_', ' ')}: {said}{asked}", _TEXT, _INK, bold=told, indent=20.0)
    if told:
        for text in filter(None, (story.words, story.caption)):
            pen.words(text, _SMALL, _DIM, indent=12.0, most=_MOST_LINES)
        edge = pen.left - 8 * pen.scale
        pen.draw.rectangle((edge, top, edge + 3 * pen.scale, pen.y - _LINE * pen.scale), fill=MOTION)


def _mark(pen: _Pen, mark: str, color: str) -> None:
    left, middle, unit = pen.left, pen.y + 0.6 * _SMALL * pen.scale, pen.scale
    match mark:
        case "arrow":
            pen.draw.line([(left, middle), (left + 12 * unit, middle)], fill=color, width=max(1, round(3 * unit)))
            tip = [
                (left + 9 * unit, middle - 5 * unit),
                (left + 17 * unit, middle),
                (left + 9 * unit, middle + 5 * unit),
            ]
            pen.draw.polygon(tip, fill=color)
        case "cone":
            ends = [(left + 16 * unit, middle - 6 * unit), (left + 16 * unit, middle + 6 * unit)]
            pen.draw.polygon([(left, middle), *ends], fill=color)
        case "dot":
            box = (left + 4 * unit, middle - 4 * unit, left + 12 * unit, middle + 4 * unit)
            pen.draw.ellipse(box, fill=color, outline="#000000")
        case _:
            box = (left + unit, middle - 5 * unit, left + 15 * unit, middle + 5 * unit)
            pen.draw.rectangle(box, fill=color, outline="#000000")
