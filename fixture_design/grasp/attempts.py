"""Attempts to reach what is wanted: inverse kinematics, what the hand runs into there, and whether it closes.

Each one ends as a draft or in words, which are counted: from them comes the reason where nothing was found. Features
take turns and are given up after some failures, so that what is found differs.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np

from fixture_design.geometry.urdf_tree import composed
from fixture_design.grasp.above_table import raised
from fixture_design.grasp.hand_model import HandModel
from fixture_design.grasp.judging import INTO_TABLE, Draft, Site, drafted, obstacle
from fixture_design.grasp.library import Library, Seed, Spots
from fixture_design.grasp.posture import Posture
from fixture_design.grasp.reach import Reach
from fixture_design.grasp.rolling import rolled
from fixture_design.grasp.wanted import Progress, Wanted
from fixture_design.layout import Pose

#: Drafts made of one family.
DRAFTS = 3

#: Failures in a row after which a family is given up.
PATIENCE = 24

#: Seeds tried for one pair of points, and those that fit best from which they are taken.
_SEEDS, _ALIKE = 6, 48

NOT_REACHED = "nothing reaches there"


@dataclass(eq=False)
class Attempts:
    """What was tried, and what became of it; a tally that grows.

    Attributes:
        most: sets of points looked at at most, those of families that are full or given up too.
        outcomes: how often what came of a set.  by_features: the same for each family.
        full: drafts made of each family.
        failures: of each family, in a row.
        stopped: whether somebody stopped it before it was done.
    """

    model: HandModel
    site: Site
    reach: Reach
    rng: np.random.Generator
    most: int
    progress: Progress
    cancelled: Callable[[], bool]
    outcomes: Counter[str] = field(default_factory=Counter)
    by_features: dict[tuple[str, ...], Counter[str]] = field(default_factory=dict)
    full: Counter[tuple[str, ...]] = field(default_factory=Counter)
    failures: Counter[tuple[str, ...]] = field(default_factory=Counter)
    stopped: bool = False

    def drafts(self, library: Library, wanted: Iterable[Wanted]) -> Iterator[Draft]:
        """Drafts of what is reached, one after the other, until enough was tried or somebody stops it."""
        found = 0
        for number, one in enumerate(wanted):
            if number >= self.most or self._is_stopped():
                return
            if self.full[one.features] >= DRAFTS or self.failures[one.features] >= PATIENCE:
                continue
            self.progress(f"{found} grasps; trying {', '.join(one.features)}", number / self.most)
            draft = self._first(one, ((seed,) for seed in one.seeds) if one.seeds else self._ways(library, one.spots))
            if draft is None:
                self.failures[one.features] += 1
                continue
            self.full[one.features] += 1
            self.failures[one.features] = 0
            found += 1
            yield draft

    def _is_stopped(self) -> bool:
        self.stopped = self.stopped or self.cancelled()
        return self.stopped

    def _ways(self, library: Library, spots: Spots) -> Iterator[Iterable[Seed]]:
        """Configurations that fit two spots, each with ways round the line between them."""
        if len(self.model.free) == 1:  # one way to be as wide as that
            seeds = library.seeds(spots, 1)
        else:
            seeds = library.seeds(spots, _ALIKE)
            # which ones differs from pair to pair: those of two parallel faces all have the same nearest ones
            seeds = [seeds[number] for number in np.sort(self.rng.choice(len(seeds), min(_SEEDS, len(seeds)), False))]
        for seed in seeds:
            yield rolled(seed, spots, self.rng)

    def _first(self, wanted: Wanted, ways: Iterable[Iterable[Seed]]) -> Draft | None:
        """The first seed that leads to a grasp; of a way that cannot be solved the others are the same but turned."""
        outcome = NOT_REACHED
        for way in ways:
            if self._is_stopped():
                return None
            for seed in way:
                found = self.reach.solve(wanted.spots, seed)
                if found is None:
                    break
                draft = self._drafted(seed, *found)
                if isinstance(draft, Draft):
                    self.outcomes["closed"] += 1
                    return draft
                outcome = draft
        self.outcomes[outcome] += 1
        self.by_features.setdefault(wanted.features, Counter())[outcome] += 1
        return None

    def _drafted(self, seed: Seed, q: np.ndarray, X_PH: Pose) -> Draft | str:
        """The grasp, or what is in its way, or why it is none."""
        posture = Posture(self.model, q, composed(self.site.part.pose, X_PH))
        tips = [self.model.fingertips[tip] for tip in seed.tips]
        in_the_way = obstacle(posture, self.site, tips)
        if in_the_way == INTO_TABLE and (higher := raised(posture, self.site, tips)) is not None:
            posture, in_the_way = higher, obstacle(higher, self.site, tips)
        return drafted(posture, self.site, tips) if in_the_way is None else in_the_way
