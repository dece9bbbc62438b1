"""Which layouts are the worst of those that have a verdict; of a sweep the worst variant alone."""

from __future__ import annotations

from collections.abc import Iterable

from fixture_design.batch.outcome import FAILURES, OUTCOMES, outcome_of, smallest_margin
from fixture_design.batch.records import Record

#: Layouts that are drawn.
MOST_PREVIEWS = 8


class Worst:
    """Remembers a few places: first those of the worst outcomes, among them those of the smallest margins."""

    def __init__(self, most: int = MOST_PREVIEWS) -> None:
        self._most = most
        self._kept: dict[object, tuple[int, float, int]] = {}

    def add(self, number: int, source: object, outcome: str, margin: float | None) -> None:
        """One more record. A source that was dropped comes back if a worse variant of it does."""
        if outcome in FAILURES:
            return
        bad = OUTCOMES.index(outcome), float("inf") if margin is None else margin, number
        self._kept[source] = min(bad, self._kept.get(source, bad))
        if len(self._kept) > self._most:
            del self._kept[max(self._kept, key=lambda source: self._kept[source])]

    @property
    def numbers(self) -> list[int]:
        """Their places, the worst first."""
        return [number for *_, number in sorted(self._kept.values())]


def worst_numbers(records: Iterable[Record], most: int = MOST_PREVIEWS) -> list[int]:
    """The places of the worst of some records."""
    worst = Worst(most)
    for number, record in enumerate(records):
        worst.add(number, record.get("source"), outcome_of(record), smallest_margin(record))
    return worst.numbers
