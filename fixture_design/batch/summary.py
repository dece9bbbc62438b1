"""What a batch came to: counts, and for each sweep the share that holds with its worst case."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from fixture_design.batch.interval import wilson_interval
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.outcome import FAILURES, OUTCOMES
from fixture_design.batch.reading import nominal_of
from fixture_design.batch.sweep import Deviations, deviations_of


@dataclass(frozen=True)
class Worst:
    """A variant, without its record and its layout: there may be many sweeps.

    Attributes:
        off: how far it is off what the layout says; None for what is no variant.
    """

    name: str
    outcome: str
    margin: float | None
    off: Deviations | None

    @classmethod
    def of(cls, item: Item, entry: Entry) -> Worst:
        off = None if item.variant is None else deviations_of(nominal_of(item), item.variant)
        return cls(json.loads(entry.line)["name"], entry.outcome, entry.margin, off)


@dataclass
class Robustness:
    """The variants of one sweep.

    Attributes:
        source: where the layout is.  sampled: whether variants were drawn at random.
        count: variants looked at.  holds: those that satisfy all requirements.
        errors: those without a verdict.  judged: the others.  nothing_required: whether no requirement was asked.
        outcomes: how many came out how.
        worst: the worst variant that has a verdict: of the worst outcome, the one of the smallest margin.
    """

    source: str
    sampled: bool = False
    count: int = 0
    outcomes: Counter[str] = field(default_factory=Counter)
    worst: Worst | None = None

    @property
    def holds(self) -> int:
        return self.outcomes["yes"]

    @property
    def errors(self) -> int:
        return sum(self.outcomes[outcome] for outcome in FAILURES)

    @property
    def judged(self) -> int:
        return self.count - self.errors

    @property
    def nothing_required(self) -> bool:
        return 0 < self.judged == self.outcomes["nothing required"]

    @property
    def interval(self) -> tuple[float, float]:
        """Of the probability that a variant holds, at 95 % confidence, for variants that were drawn at random."""
        return wilson_interval(self.holds, self.judged)

    def add(self, item: Item, entry: Entry) -> None:
        """Counts one more variant."""
        self.count += 1
        self.outcomes[entry.outcome] += 1
        if entry.outcome in FAILURES:
            return
        if self.worst is None or _badness(entry.outcome, entry.margin) < _badness(
            self.worst.outcome, self.worst.margin
        ):
            self.worst = Worst.of(item, entry)

    def as_dict(self) -> dict[str, Any]:
        low, high = self.interval
        worst = None
        if self.worst is not None:
            off = self.worst.off
            worst = {
                "name": self.worst.name, "outcome": self.worst.outcome, "margin": self.worst.margin,
                "off": None if off is None else off.as_dict(),
            }  # fmt: skip
        return {
            "source": self.source, "count": self.count, "holds": self.holds,
            "errors": self.errors, "fraction": self.holds / self.judged if self.judged else None,
            "interval": [low, high] if self.sampled else None, "worst": worst,
        }  # fmt: skip


@dataclass
class Summary:
    """Counts of a batch, kept while it runs.

    Attributes:
        resumed: how many records were there before.  retried: how many of them were errors and were made again.
        interrupted: whether it was stopped before its end.
    """

    outcomes: Counter[str] = field(default_factory=Counter)
    sweeps: dict[str, Robustness] = field(default_factory=dict)
    resumed: int = 0
    retried: int = 0
    interrupted: bool = False

    @property
    def count(self) -> int:
        return self.outcomes.total()

    def add(self, item: Item, entry: Entry) -> None:
        """Counts one more record."""
        self.outcomes[entry.outcome] += 1
        if item.variant is not None:
            self.sweeps.setdefault(item.source, Robustness(item.source, item.sampled)).add(item, entry)

    def as_dict(self) -> dict[str, Any]:
        return {
            "count": self.count,
            "outcomes": {outcome: self.outcomes[outcome] for outcome in reversed(OUTCOMES)},
            "resumed": self.resumed,
            "retried": self.retried,
            "interrupted": self.interrupted,
            "sweeps": [sweep.as_dict() for sweep in self.sweeps.values()],
        }


def _badness(outcome: str, margin: float | None) -> tuple[int, float]:
    """Smaller is worse."""
    return OUTCOMES.index(outcome), float("inf") if margin is None else margin
