"""What a batch came to: counts, and for each sweep the share that holds with its worst case."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from fixture_design.batch.interval import wilson_interval
from fixture_design.batch.item import Entry, Item
from fixture_design.batch.outcome import OUTCOMES
from fixture_design.batch.reading import nominal_of
from fixture_design.batch.sweep import Deviations, deviations_of


@dataclass
class Robustness:
    """The variants of one sweep.

    Attributes:
        source: where the layout is.  sampled: whether variants were drawn at random.
        count: variants looked at.  holds: those that satisfy all requirements.
        outcomes: how many came out how.
        worst: the worst variant: of the worst outcome, the one of the smallest margin.  worst_item: its item.
    """

    source: str
    sampled: bool = False
    count: int = 0
    outcomes: Counter[str] = field(default_factory=Counter)
    worst: Entry | None = None
    worst_item: Item | None = None

    @property
    def holds(self) -> int:
        return self.outcomes["yes"]

    @property
    def interval(self) -> tuple[float, float]:
        """Of the probability that a variant holds, at 95 % confidence, for variants that were drawn at random."""
        return wilson_interval(self.holds, self.count)

    @property
    def worst_name(self) -> str | None:
        """The name of the worst variant."""
        return None if self.worst is None else json.loads(self.worst.line)["name"]

    @property
    def worst_off(self) -> Deviations | None:
        """How far the worst variant is off what the layout says."""
        if self.worst_item is None or self.worst_item.variant is None:
            return None
        return deviations_of(nominal_of(self.worst_item), self.worst_item.variant)

    def add(self, item: Item, entry: Entry) -> None:
        """Counts one more variant."""
        self.count += 1
        self.outcomes[entry.outcome] += 1
        if self.worst is None or _badness(entry) < _badness(self.worst):
            self.worst, self.worst_item = entry, item

    def as_dict(self) -> dict[str, Any]:
        low, high = self.interval
        worst = None
        if self.worst is not None:
            off = self.worst_off
            worst = {
                "name": self.worst_name, "outcome": self.worst.outcome, "margin": self.worst.margin,
                "off": None if off is None else off.as_dict(),
            }  # fmt: skip
        return {
            "source": self.source, "count": self.count, "holds": self.holds,
            "fraction": self.holds / self.count, "interval": [low, high] if self.sampled else None, "worst": worst,
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


def _badness(entry: Entry) -> tuple[int, float]:
    """Smaller is worse."""
    return OUTCOMES.index(entry.outcome), float("inf") if entry.margin is None else entry.margin
