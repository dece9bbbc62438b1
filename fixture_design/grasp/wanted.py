"""Where the fingers are to go: sets of points with the features they are on, in the order in which they are tried."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from fixture_design.geometry import PartGeometry, SurfacePoints
from fixture_design.grasp.hand_model import HandModel
from fixture_design.grasp.library import Library, Seed, Spots
from fixture_design.grasp.skin import Skin
from fixture_design.grasp.spots import feature, spots_at

#: Words and how much is done, 0 to 1.
Progress = Callable[[str, float], None]

#: Seeds that are looked up for each set, and those of all seeds that are compared by what runs into the part.
_LOOKED_UP, _COMPARED = 4, 600

#: Sets that miss by more than this before inverse kinematics are not tried [m].
_TOO_FAR = 0.03


@dataclass(frozen=True, eq=False)
class Wanted:
    """A set of spots to be reached, the features they are on, and seeds, where they were looked up already."""

    spots: Spots
    features: tuple[str, ...]
    seeds: tuple[Seed, ...] = ()

    @classmethod
    def of(
        cls, geometry: PartGeometry, points: SurfacePoints, chosen: np.ndarray, seeds: tuple[Seed, ...] = ()
    ) -> Wanted:
        """Some points of a part."""
        names = tuple(sorted(feature(geometry, int(points.facets[number])) for number in chosen))
        return cls(spots_at(points, chosen), names, seeds)


def fitting(
    library: Library,
    geometry: PartGeometry,
    points: SurfacePoints,
    sets: np.ndarray,
    progress: Progress,
    cancelled: Callable[[], bool],
) -> list[Wanted]:
    """Sets of points with the seeds that fit, first those that miss least with least of the hand in the part."""
    fits = []
    for number, chosen in enumerate(sets):
        seeds = library.seeds(spots_at(points, chosen), _LOOKED_UP)
        fits += [(seed.off, number, seed) for seed in seeds if seed.off <= _TOO_FAR]
    fits = sorted(fits, key=lambda fit: fit[:2])[:_COMPARED]
    ranked = []
    for off, number, seed, depth in _with_depths(library.model, geometry, fits, progress, cancelled):
        ranked.append((off + depth, number, seed))
    ranked.sort(key=lambda fit: fit[:2])
    return [Wanted.of(geometry, points, sets[number], (seed,)) for _, number, seed in ranked]


def _with_depths(
    model: HandModel,
    geometry: PartGeometry,
    fits: Sequence[tuple[float, int, Seed]],
    progress: Progress,
    cancelled: Callable[[], bool],
) -> Iterator[tuple[float, int, Seed, float]]:
    skin = Skin.of(model)
    for done, (off, number, seed) in enumerate(fits):
        if cancelled():
            return
        progress("looking for ways to reach around the part", done / len(fits))
        yield off, number, seed, skin.depth(seed, geometry)


def in_turns(lists: Sequence[Sequence[Wanted]]) -> Iterator[Wanted]:
    """One of each list, then the second of each, and so on."""
    for number in range(max(map(len, lists), default=0)):
        yield from (one[number] for one in lists if number < len(one))
