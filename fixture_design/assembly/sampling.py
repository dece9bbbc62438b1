"""The modified Monte Carlo method (section 3.3.1, Figure 13).

Random configurations almost never touch. So contact equations are chosen a priori, random starts are moved to where
they hold, and each result is sorted into the state it is in: often one with more contacts than were asked for.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from fixture_design.assembly.contact_geometry import ContactGeometry
from fixture_design.assembly.least_squares import solved
from fixture_design.assembly.sorting import Sorted, joined, sort_configurations
from fixture_design.assembly.symmetry import Symmetries
from fixture_design.tolerances import SOLVED

#: Starts for each chosen set, by its number of equations.
_STARTS = {0: 64, 1: 24, 2: 8, 3: 4}

#: More sets of one size than this are not all tried: as many are drawn.
_MOST_SETS = 6000

#: Starts that are moved together.
_TOGETHER = 4096


def chosen_sets(geometry: ContactGeometry, size: int, rng: np.random.Generator) -> np.ndarray:
    """Sets of pairs that may touch at once (3-18) to (3-20), shape (s, size); at most `_MOST_SETS` of them.

    No more equations than the configuration has freedoms are independent, so that larger sets are not chosen.
    """
    return _some(_possible_sets(geometry, size, rng), rng)


def _some(sets: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return sets[rng.permutation(len(sets))[:_MOST_SETS]] if len(sets) > _MOST_SETS else sets


def _possible_sets(geometry: ContactGeometry, size: int, rng: np.random.Generator) -> np.ndarray:
    possible = geometry.possible_together()
    taking = np.flatnonzero(geometry.takes_part)
    if size == 0:
        return np.zeros((1, 0), dtype=int)
    if size < 3:
        rows = np.array(list(combinations(taking, size)), dtype=int).reshape(-1, size)
    else:
        smaller = chosen_sets(geometry, size - 1, rng)
        grown = [np.column_stack([np.repeat(row[None], later.size, axis=0), later])
                 for row in smaller if (later := taking[taking > row[-1]]).size]  # fmt: skip
        rows = np.vstack(grown) if grown else np.zeros((0, size), dtype=int)
    for first, second in combinations(range(size), 2):
        rows = rows[possible[rows[:, first], rows[:, second]]]
    return rows


def _tried(geometry: ContactGeometry, size: int, rng: np.random.Generator, symmetries: Symmetries) -> np.ndarray:
    """The sets of all starts: where there are many, one of those that are each other's images has the starts of all."""
    sets, times = _possible_sets(geometry, size, rng), 1
    if len(sets) > _MOST_SETS and len(symmetries) > 1:
        sets = sets[symmetries.first_of_sets(sets)]
        times = max(_MOST_SETS // len(sets), 1)
    return np.repeat(_some(sets, rng), _STARTS[size] * times, axis=0)


def sample(geometry: ContactGeometry, rng: np.random.Generator, symmetries: Symmetries, most: int = 3) -> Sorted:
    """Configurations found from random starts, only admissible ones whose state is clear.

    Args:
        symmetries: where there are many sets, one of those that are each other's images has the starts of all.
        most: size of the largest sets of contact equations.
    """
    found = []
    for size in range(most + 1):
        tried = _tried(geometry, size, rng, symmetries)
        for k in range(0, len(tried), _TOGETHER):
            found.append(_from_random_starts(geometry, tried[k : k + _TOGETHER], rng))
    return joined(found)


def _from_random_starts(geometry: ContactGeometry, sets: np.ndarray, rng: np.random.Generator) -> Sorted:
    return onto(geometry, geometry.random(rng, len(sets)), sets)


def onto(geometry: ContactGeometry, starts: np.ndarray, sets: np.ndarray, *, turning: bool = True) -> Sorted:
    """The starts moved onto their sets of equations: those that arrive, are admissible, and have a clear state."""
    if sets.shape[1]:
        starts, left = solved(geometry, starts, sets, turning=turning)
        starts = starts[left <= SOLVED * geometry.size]
    found = sort_configurations(geometry, starts)
    return found[found.clear]


def onto_all(geometry: ContactGeometry, starts: np.ndarray, touching: np.ndarray) -> Sorted:
    """As `onto`, the sets of equations as masks (n, P): those with as many together, none with more than it has."""
    counts = touching.sum(axis=1)
    found = [sort_configurations(geometry, starts[:0])]
    for count in np.unique(counts).tolist():
        rows = np.flatnonzero(counts == count)
        found.append(onto(geometry, starts[rows], np.nonzero(touching[rows])[1].reshape(len(rows), count)))
    return joined(found)
