"""The contact state graph as a drawing: a small picture of each state, in rows by the number of contacts."""

from __future__ import annotations

from io import BytesIO
from itertools import groupby
from pathlib import Path

import numpy as np

from fixture_design.assembly import ContactState, ContactStateGraph
from fixture_design.errors import UnsupportedError
from fixture_design.io.text_file import write_bytes, write_text
from fixture_design.viewing.graph_outlines import Outlines, outlines_of
from fixture_design.viewing.markup import Markup, tag

#: Width and height of a state's drawing, what is free around it, height of its name; in the drawing's units.
_WIDTH, _HEIGHT, _GAP, _ROW_GAP, _TEXT = 120.0, 90.0, 16.0, 60.0, 10.0

#: States in a row, at most.
_IN_A_ROW = 12

#: Size of what a drawing shows for that of what moves in it [-].
_ROOM = 1.15

#: What the frame of some states says.
COINCIDENT = "two corners in one point"

#: Units of the drawing in an inch of a PNG.
_DOTS = 100.0

_EDGE, _LINE = "#8a8580", "#9aa5ae"
MARKED = "#c1440e"


def write_graph_picture(graph: ContactStateGraph, path: str | Path) -> None:
    """Writes the picture as SVG or PNG, by the name's end.

    Raises:
        UnsupportedError: another kind of picture.
        FileFormatError: the file cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() == ".svg":
        write_text(path, graph_picture(graph) + "\n")
    elif path.suffix.lower() == ".png":
        write_bytes(path, graph_png(graph))
    else:
        raise UnsupportedError("graphs are drawn as SVG or PNG", source=path, expected="a name with .svg or .png")


def graph_picture(graph: ContactStateGraph) -> Markup:
    """The graph as SVG: states by their number of contacts from top to bottom, lines where a transition is direct."""
    outlines = outlines_of(graph, _WIDTH, _HEIGHT)
    places = _places(graph.states)
    width, height = _paper(places)
    lines = [_line(places[edge.loose], places[edge.tight]) for edge in graph.transitions]
    drawings = [_drawing(outlines, state, places[state.id]) for state in graph.states]
    return tag(
        "svg", tag("rect", width="100%", height="100%", fill="white"), *lines, *drawings,
        xmlns="http://www.w3.org/2000/svg", viewBox=f"0 0 {width:g} {height:g}", width=f"{width:g}",
        height=f"{height:g}", font_family="sans-serif", font_size=_TEXT,
    )  # fmt: skip


def _places(states: tuple[ContactState, ...]) -> dict[str, tuple[float, float]]:
    """The upper left corner of each state's drawing."""
    rows: list[list[ContactState]] = []
    for _, same in groupby(states, key=lambda state: len(state.contacts)):
        members = list(same)
        rows += [members[k : k + _IN_A_ROW] for k in range(0, len(members), _IN_A_ROW)]
    widest = max(map(len, rows))
    places = {}
    for row, members in enumerate(rows):
        left = _GAP + (widest - len(members)) / 2 * (_WIDTH + _GAP)
        for column, state in enumerate(members):
            places[state.id] = left + column * (_WIDTH + _GAP), _GAP + row * (_HEIGHT + _ROW_GAP)
    return places


def _ends(above: tuple[float, float], below: tuple[float, float]) -> tuple[tuple[float, float], tuple[float, float]]:
    """From the lower side of the state with fewer contacts to the upper side of the other."""
    return (above[0] + _WIDTH / 2, above[1] + _HEIGHT + _TEXT + 4), (below[0] + _WIDTH / 2, below[1])


def _line(above: tuple[float, float], below: tuple[float, float]) -> Markup:
    start, end = _ends(above, below)
    return tag("line", x1=start[0], y1=start[1], x2=end[0], y2=end[1], stroke=_LINE, stroke_width=0.7)


def _drawing(outlines: Outlines, state: ContactState, place: tuple[float, float]) -> Markup:
    """One sample of a state, with its name below."""
    shapes = [
        tag("path", d=" ".join(map(_ring, outline.rings)), fill=outline.color, fill_opacity=outline.opacity,
            stroke="black", stroke_width=0.6)
        for outline in outlines(state)
    ]  # fmt: skip
    inner = tag("svg", *shapes, x=place[0], y=place[1], width=_WIDTH, height=_HEIGHT, overflow="hidden")
    frame = tag("rect", x=place[0], y=place[1], width=_WIDTH, height=_HEIGHT, fill="white", stroke=_frame(state))
    title = tag("title", "; ".join(state.contacts) or "no contact")
    name = tag("text", state.id, x=place[0] + _WIDTH / 2, y=place[1] + _HEIGHT + _TEXT, text_anchor="middle")
    return tag("g", title, frame, inner, name)


def _ring(points: np.ndarray) -> str:
    return "M" + "L".join(f"{x:.2f},{y:.2f}" for x, y in points.tolist()) + "Z"


def graph_png(graph: ContactStateGraph) -> bytes:
    """The same drawing as PNG by matplotlib, which Drake brings along."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: PLC0415 - half a second of any start
    from matplotlib.figure import Figure  # noqa: PLC0415 - as above
    from matplotlib.patches import PathPatch, Rectangle  # noqa: PLC0415 - as above
    from matplotlib.path import Path as Curve  # noqa: PLC0415 - as above

    outlines = outlines_of(graph, _WIDTH, _HEIGHT)
    places = _places(graph.states)
    width, height = _paper(places)
    figure = Figure(figsize=(width / _DOTS, height / _DOTS), dpi=1.5 * _DOTS)
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, width), ylim=(height, 0))
    axes.set_axis_off()
    for edge in graph.transitions:
        start, end = _ends(places[edge.loose], places[edge.tight])
        axes.plot([start[0], end[0]], [start[1], end[1]], color=_LINE, linewidth=0.5, zorder=1)
    for state in graph.states:
        place = places[state.id]
        frame = Rectangle(place, _WIDTH, _HEIGHT, facecolor="white", edgecolor=_frame(state), zorder=2)
        axes.add_patch(frame)
        for outline in outlines(state):
            rings = [Curve(np.vstack([ring, ring[:1]]) + place, closed=True) for ring in outline.rings]
            shape = PathPatch(
                Curve.make_compound_path(*rings), facecolor=outline.color, edgecolor="black", linewidth=0.5,
                alpha=outline.opacity, zorder=3,
            )  # fmt: skip
            axes.add_patch(shape)
            shape.set_clip_path(frame)
        axes.text(place[0] + _WIDTH / 2, place[1] + _HEIGHT + _TEXT, state.id, ha="center", fontsize=_TEXT * 0.7)
    if any(state.coincident for state in graph.states):
        axes.text(_GAP, height - _TEXT, f"orange frame: {COINCIDENT}", color=MARKED, fontsize=_TEXT * 0.7)
    file = BytesIO()
    FigureCanvasAgg(figure).print_png(file)
    return file.getvalue()


def _frame(state: ContactState) -> str:
    """States with two apices in one point stand out."""
    return MARKED if state.coincident else _EDGE


def _paper(places: dict[str, tuple[float, float]]) -> tuple[float, float]:
    """Width and height of the whole drawing."""
    width = max(x for x, _ in places.values()) + _WIDTH + _GAP
    return width, max(y for _, y in places.values()) + _HEIGHT + _ROW_GAP
