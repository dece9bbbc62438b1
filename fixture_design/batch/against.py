"""The same library against an earlier run: what changed its verdict, what lost margin, what is new or gone."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fixture_design.batch.outcome import OUTCOMES, outcome_of, required_margins
from fixture_design.batch.records import Record
from fixture_design.batch.results import key_of, records_in
from fixture_design.errors import FileFormatError

#: Margins that are smaller by this part of what they were are said to be lost [-]: less is rounding, or nobody's worry.
LOST = 0.01


@dataclass(frozen=True)
class Change:
    """One layout that is not what it was.

    Attributes:
        what: "verdict", or the requirement whose margin was lost.
        before, after: outcomes or margins.
    """

    name: str
    source: str
    what: str
    before: str | float
    after: str | float


@dataclass
class Comparison:
    """Everything that differs between two runs of a library.

    Attributes:
        changed: layouts of another outcome, what became worse first.  lost: margins, the largest loss first.
        new, gone: names of the layouts that only one of them has.  same: how many layouts are in both.
    """

    changed: list[Change] = field(default_factory=list)
    lost: list[Change] = field(default_factory=list)
    new: list[str] = field(default_factory=list)
    gone: list[str] = field(default_factory=list)
    same: int = 0

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON."""
        lists = {key: [vars(change) for change in getattr(self, key)] for key in ("changed", "lost")}
        return {**lists, "new": self.new, "gone": self.gone, "same": self.same}


class _Earlier:
    """The layouts of an earlier output, to be found again once each: by source and name, or by one that tells."""

    def __init__(self, path: Path) -> None:
        self._left: dict[int, tuple[str, str, tuple[tuple[str, float | None], ...]]] = {}
        self._numbers: dict[tuple[str | None, str | None], list[int]] = {}
        for number, record in enumerate(records_in(path)):
            source, name = key_of(record)
            self._left[number] = (name, outcome_of(record), tuple(required_margins(record)))
            for key in ((source, name), (None, name), (source, None)):
                self._numbers.setdefault(key, []).append(number)

    def take(self, record: Record) -> tuple[str, tuple[tuple[str, float | None], ...]] | None:
        """Outcome and margins that a layout had; a library may have moved, and a broken layout has lost its name."""
        source, name = key_of(record)
        for key in ((source, name), (None, name), (source, None)):
            numbers = self._numbers.get(key, [])
            if len(numbers) > 1 and None in key:
                continue
            number = next((number for number in numbers if number in self._left), None)
            if number is not None:
                return self._left.pop(number)[1:]
        return None

    @property
    def left(self) -> list[str]:
        """Names of those that were not found again."""
        return [name for name, _, _ in self._left.values()]


def compare(new: Path, old: Path) -> Comparison:
    """What the output ``new`` says otherwise than the output ``old``.

    Raises:
        FileFormatError: a file cannot be read, or they have no layout in common.
    """
    earlier, found = _Earlier(old), Comparison()
    for record in records_in(new):
        was = earlier.take(record)
        if was is None:
            found.new.append(record["name"])
            continue
        found.same += 1
        outcome, margins = was
        if outcome_of(record) != outcome:
            found.changed.append(_change(record, "verdict", outcome, outcome_of(record)))
        found.lost += _losses(record, margins)
    found.gone = earlier.left
    if not found.same and (found.new or found.gone):
        raise FileFormatError(
            "no layout of this batch is among these records, by source or name", source=old,
            expected="the output of an earlier batch of the same library",
        )  # fmt: skip
    found.changed.sort(key=lambda change: OUTCOMES.index(str(change.after)) - OUTCOMES.index(str(change.before)))
    found.lost.sort(key=lambda change: float(change.after) - float(change.before))
    return found


def _losses(record: Record, before: Iterable[tuple[str, float | None]]) -> Iterator[Change]:
    were = dict(before)
    for what, margin in required_margins(record):
        was = were.get(what)
        if was is not None and margin is not None and was - margin > LOST * abs(was):
            yield _change(record, what, was, margin)


def _change(record: Record, what: str, before: str | float, after: str | float) -> Change:
    source, name = key_of(record)
    return Change(name, source, what, before, after)
