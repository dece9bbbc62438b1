"""The part from above, from the front and from the right, with its contacts: a drawing to check by eye."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.arrays import Ends, Point, Points
from fixture_design.contacts import Contact, Role, unit_normal
from fixture_design.viewing.markup import Markup, joined, tag

#: Which coordinates of W each view shows, to the right and up.
_VIEWS = (("from above", (0, 1)), ("from the front", (0, 2)), ("from the right", (1, 2)))
_PLANAR_VIEWS = (("in the plane", (0, 1)),)
#: Width of a view and what is left free around the part, in the drawing's units.
_WIDTH, _ROOM = 320.0, 60.0
#: Length of a normal's arrow, radius of a contact's dot, height of its name.
_ARROW, _DOT, _TEXT = 26.0, 3.0, 10.0

ROLE_COLORS: dict[Role, str] = {"locator": "#1b6ca8", "support": "#6a4c93", "clamp": "#c1440e", "finger": "#2d6a4f"}


def three_views(segments: Ends, contacts: Sequence[Contact]) -> Markup:
    """One drawing a view.

    Args:
        segments: the part's edges in W, shape (e, 2, p) [m]; none for layouts of contacts alone.
        contacts: drawn as dots with arrows along the force they push the part with.
    """
    planar = len(contacts[0].point) == 2
    points = np.array([contact.point for contact in contacts])
    everything = np.vstack([segments.reshape(-1, points.shape[1]), points])
    views = _PLANAR_VIEWS if planar else _VIEWS
    return tag("div", *(_view(name, axes, segments, contacts, everything) for name, axes in views), class_="views")


@dataclass(frozen=True, eq=False)
class _Paper:
    """Where points of W are on the drawing: x to the right, y down."""

    axes: tuple[int, int]
    low: Point
    scale: float
    height: float

    @classmethod
    def of(cls, axes: tuple[int, int], everything: Points) -> _Paper:
        seen = everything[:, list(axes)]
        low, size = seen.min(axis=0), np.ptp(seen, axis=0)
        largest = float(np.ptp(everything, axis=0).max())  # one scale for all views
        scale = (_WIDTH - 2 * _ROOM) / (largest if largest > 0 else 1.0)
        return cls(axes, low, scale, float(size[1]) * scale + 2 * _ROOM)

    def at(self, point: Point) -> tuple[float, float]:
        x, y = (point[list(self.axes)] - self.low) * self.scale
        return round(float(x) + _ROOM, 2), round(self.height - _ROOM - float(y), 2)


def _view(name: str, axes: tuple[int, int], segments: Ends, contacts: Sequence[Contact], everything: Points) -> Markup:
    paper = _Paper.of(axes, everything)
    edges = joined(tag("path", d=_path(paper, segments), fill="none", stroke="#444", stroke_width=0.8) for _ in "e")
    marks = joined([*(_mark(paper, contact) for contact in contacts), *_names(paper, contacts)])
    height = round(paper.height, 1)
    drawing = tag("svg", edges, marks, viewBox=f"0 0 {_WIDTH} {height}", width=_WIDTH, height=height, role="img")
    letters = "".join("xyz"[axis] for axis in axes)
    return tag("figure", drawing, tag("figcaption", f"{name} ({letters[0]} to the right, {letters[1]} up)"))


def _path(paper: _Paper, segments: Ends) -> str:
    """All edges as one path, those behind each other once; those seen end on are dots of no length, and left out."""
    lines = []
    for start, end in segments:
        (x, y), (u, v) = sorted((paper.at(start), paper.at(end)))
        if (x, y) != (u, v):
            lines.append(f"M{x} {y}L{u} {v}")
    return "".join(dict.fromkeys(lines))


def _mark(paper: _Paper, contact: Contact) -> Markup:
    """A dot, and an arrow for every normal that is seen from the side."""
    x, y = paper.at(contact.point)
    color = ROLE_COLORS[contact.role]
    arrows = []
    for normal in contact.normals:
        across = unit_normal(normal)[list(paper.axes)]
        if np.linalg.norm(across) * _ARROW > _DOT:
            u, v = x + float(across[0]) * _ARROW, y - float(across[1]) * _ARROW
            line = {"x1": round(u, 2), "y1": round(v, 2), "x2": x, "y2": y}
            arrows.append(tag("line", stroke=color, stroke_width=1.5, **line))
    dot = tag("circle", cx=x, cy=y, r=_DOT, fill=color)
    return joined([*arrows, dot])


def _names(paper: _Paper, contacts: Sequence[Contact]) -> list[Markup]:
    """The names of the contacts, together where they are seen in one place."""
    places: dict[tuple[float, float], list[Contact]] = {}
    for contact in contacts:
        x, y = paper.at(contact.point)
        places.setdefault((round(x), round(y)), []).append(contact)
    return [
        tag(
            "text", ", ".join(contact.name for contact in there), x=x + _DOT + 1, y=y - _DOT - 1,
            fill=ROLE_COLORS[there[0].role], font_size=_TEXT,
        )
        for (x, y), there in places.items()
    ]  # fmt: skip
