"""Problems of a file's content: many may be found, one error reports them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from fixture_design.errors import FileFormatError
from fixture_design.io.documents import Document
from fixture_design.io.places import KeyPath


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong at one place.

    Attributes:
        found, expected: as in `InputError`.
        also: another place that has to do with it.
    """

    path: KeyPath
    text: str
    found: str | None = None
    expected: str | None = None
    also: KeyPath | None = None


class ContentError(FileFormatError):
    """A file parses, but does not follow its format. The message tells the first problem and counts the others.

    Attributes:
        problems: all of them, in the order of the file.
    """

    def __init__(self, problems: tuple[Problem, ...], document: Document) -> None:
        first = problems[0]
        super().__init__(
            first.text if first.also is None else f"{first.text}, first at {document.place.describe(first.also)}",
            source=document.source,
            place=document.place.describe(first.path),
            found=first.found,
            expected=first.expected,
        )
        self.problems = problems

    def __str__(self) -> str:
        others = len(self.problems) - 1
        more = f" (and {others} more problem{'s' if others > 1 else ''})" if others else ""
        return super().__str__() + more


def content_error(problems: Iterable[Problem], document: Document) -> ContentError:
    """The error that reports these problems, first in the file first."""

    def position(problem: Problem) -> tuple[int, int]:
        place = document.place.at(problem.path)
        return place.line or 0, place.column or 0

    return ContentError(tuple(sorted(problems, key=position)), document)


def show(value: object) -> str:
    """A value as a message may quote it: short, and in the file's words."""
    if value is None:
        return "nothing (null)"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)} value{'s' if len(value) != 1 else ''}"
    if isinstance(value, dict):
        return f"a mapping with the keys {', '.join(map(str, value))}"[:80] if value else "an empty mapping"
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def either(names: Iterable[str]) -> str:
    """ "locator, support, clamp or finger"."""
    *others, last = names
    return f"{', '.join(others)} or {last}" if others else last
