"""HTML and SVG as text: everything that comes from files is escaped, what is markup already says so by its type."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from fixture_design.layout import Answer


class Markup(str):
    """Text that is markup: not escaped again."""

    __slots__ = ()


def tag(name: str, *children: object, **attributes: object) -> Markup:
    """<name key="value">children</name>; ``class_`` is class, underscores in keys are hyphens.

    Children are markup or anything else, which is escaped; None and False attributes are left out.

    >>> tag("td", "a < b", class_="no")
    '<td class="no">a &lt; b</td>'
    """
    keys = {key.rstrip("_").replace("_", "-"): value for key, value in attributes.items()}
    given = "".join(
        f' {key}="{escape(str(value))}"' for key, value in keys.items() if value is not None and value is not False
    )
    return Markup(f"<{name}{given}>{joined(children)}</{name}>")


def joined(children: Iterable[object], between: str = "") -> Markup:
    """Children one after the other."""
    return Markup(between.join(child if isinstance(child, Markup) else escape(str(child)) for child in children))


def table(headings: Sequence[object], rows: Iterable[Sequence[object]], class_: str | None = None) -> Markup:
    """A table with one row of headings; cells that are markup stay."""
    head = tag("thead", tag("tr", *(tag("th", heading) for heading in headings)))
    body = tag("tbody", *(tag("tr", *(tag("td", cell) for cell in row)) for row in rows))
    return tag("table", head, body, class_=class_)


def bullets(items: Iterable[object]) -> Markup:
    return tag("ul", *(tag("li", item) for item in items))


def answer_cell(answer: Answer | None) -> Markup:
    """The word, coloured."""
    return tag("span", "no contacts" if answer is None else str(answer), class_=f"answer {answer or 'none'}")
