"""How much sampling has not seen: the estimate of Good and Turing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from fixture_design.assembly.sorting import State


@dataclass(frozen=True)
class Unseen:
    """What the random starts say of states that they did not lead to.

    Attributes:
        starts: random starts that ended in an admissible configuration.
        once: states that exactly one of them ended in.
        found_by_starts: states that some of them ended in; found: all, with those that completion added.
    """

    starts: int
    once: int
    found_by_starts: int
    found: int

    @property
    def chance(self) -> float:
        """Chance that one more start ends in a state that no start ended in so far: once / starts (Good, 1953)."""
        return self.once / self.starts if self.starts else 1.0


def unseen(states: Iterable[State], counts: Mapping[State, int]) -> Unseen:
    """The estimate.

    Args:
        states: all that were found.  counts: how many starts ended in each.
    """
    once = sum(1 for count in counts.values() if count == 1)
    return Unseen(sum(counts.values()), once, len(counts), len(set(states)))
