"""What a search found so far: of each family, the fingers on the same features, the best grasp; and why there is none.

Good are grasps that are closed by proof and hold the load, if one was asked for.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from fixture_design.arrays import Vector
from fixture_design.grasp.judging import (
    Draft,
    Site,
    better_first,
    judged,
    with_load,
    with_told_robustness,
    with_weakest,
)
from fixture_design.grasp.result import Grasp
from fixture_design.grasp.robustness import PoseError
from fixture_design.grasp.wanted import Progress
from fixture_design.layout import Answer

#: Drafts of one family that are judged.
JUDGED = 2


@dataclass(eq=False)
class Finds:
    """The grasps of a search; a collection that grows.

    Attributes:
        best: of each family.
    """

    site: Site
    error: PoseError
    seed: int
    load: Vector | None
    progress: Progress
    best: dict[tuple[str, ...], Grasp] = field(default_factory=dict)

    def judge(self, drafts: Sequence[Draft]) -> None:
        """Takes the best of some drafts in."""
        chosen = _best_of_each(drafts)
        for number, draft in enumerate(chosen):
            self.progress("judging what was found", number / len(chosen))
            grasp = with_load(judged(draft, self.site, self.error, self.seed), self.load)
            rivals = [grasp, *filter(None, [self.best.get(grasp.features)])]
            self.best[grasp.features] = self._ordered(rivals)[0]

    @property
    def good(self) -> Mapping[tuple[str, ...], Grasp]:
        """Those that are closed and hold the load."""
        return {features: grasp for features, grasp in self.best.items() if self._is_good(grasp)}

    def grasps(self, most: int) -> tuple[Grasp, ...]:
        """Up to so many, the good ones first, with what they hold in the worst direction.

        Those that are kept are measured again, and ordered by that.
        """
        kept = [self._told(grasp) for grasp in self._ordered(list(self.best.values()))[:most]]
        return tuple(map(with_weakest, self._ordered(kept)))

    def _ordered(self, grasps: Sequence[Grasp]) -> list[Grasp]:
        """Good ones first, whatever else they are worth."""
        return sorted(better_first(grasps), key=self._is_good, reverse=True)

    def _told(self, grasp: Grasp) -> Grasp:
        return with_told_robustness(grasp, self.site, self.error, self.seed)

    def tight(self) -> set[tuple[str, ...]]:
        """Families whose best grasp leaves little of the friction."""
        return {features for features, grasp in self.best.items() if grasp.tight}

    @property
    def reason(self) -> str | None:
        """Why none is good; None where there are none at all."""
        grasps = self.best.values()
        if not grasps:
            return None
        if self.load is None:
            return "the verdicts of all grasps that were found are undecided"
        if all(grasp.held is None for grasp in grasps):
            return "no grasp that was found holds the load"
        return "the verdicts of all grasps that were found and hold the load are undecided"

    def _is_good(self, grasp: Grasp) -> bool:
        return grasp.closed is Answer.YES and (self.load is None or grasp.held is not None)


def reason_of(outcomes: Counter[str]) -> str:
    """Why no grasp was found, from what became of what was tried."""
    if not outcomes:
        return "nothing was found"
    told = "; ".join(f"{words} ({count})" for words, count in outcomes.most_common(4))
    return f"no grasp was found: {told}"


def _best_of_each(drafts: Sequence[Draft]) -> list[Draft]:
    """The drafts of each family that are best by epsilon, or where it is not known by least weight."""

    def worth(draft: Draft) -> float:
        return draft.quality.least_weight if draft.quality.epsilon is None else draft.quality.epsilon

    families: dict[tuple[str, ...], list[Draft]] = {}
    for draft in sorted(drafts, key=worth, reverse=True):
        families.setdefault(draft.features, []).append(draft)
    return [draft for family in families.values() for draft in family[:JUDGED]]
