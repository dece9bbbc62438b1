"""Where a circle is on a rim, but what is solved does not tell which of their pairs touch there.

Circles that cross have a pair of their own; where they touch along each other, what goes on from the circle on both
sides touches the rim too, and the circle the wall. In between, up to `ALONGSIDE`, neither is told.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from fixture_design.assembly.circle_crossings import ALONGSIDE
from fixture_design.assembly.circles import ALONG, crossed, lengths_of
from fixture_design.assembly.placement import Placement
from fixture_design.assembly.round_features import RoundPair
from fixture_design.assembly.touch import Touch
from fixture_design.tolerances import APART, TOUCHING

#: `APART` by this is neither apart nor touching, and `TOUCHING` by this is not known to be solved [-].
_BETWEEN = 30.0


def doubted(
    pairs: Sequence[RoundPair], place: Placement, touches: Sequence[Touch], distances: np.ndarray, size: float
) -> np.ndarray:
    """The distances (n, P), those of crossings neither certainly touching nor apart where that is in doubt.

    Where circles nearly touch along each other, but what goes on from them does not all touch, they cross: the pair
    touches, as far as is known. Where their planes are nearly the same, nothing is said.
    """
    places = {name: k for k, name in enumerate(name for pair in pairs for name in pair.names)}
    near = distances <= TOUCHING * size
    for pair in pairs:
        if pair.rim_axis is not None:
            number, beside = places[pair.names[0]], [places[name] for name in pair.joins if name in places]
            unmet = ~touches[number].exists
            sine = lengths_of(crossed(place.axis, np.broadcast_to(pair.rim_axis, place.axis.shape)))
            tilted = unmet & (sine > ALONG) & (sine < ALONGSIDE) & (near[:, beside].sum(axis=1) > 1)
            distances[tilted, number] = APART / _BETWEEN * size
            _, facet, *_ = pair.joins
            rest = [k for k in beside if k != places.get(facet)]
            for j, k in combinations(beside, 2):
                rows = np.flatnonzero(unmet & near[:, j] & near[:, k] & ~near[:, rest].all(axis=1))
                apart = lengths_of(touches[j].point[rows] - touches[k].point[rows])
                distances[rows[apart <= APART * size], number] = TOUCHING / _BETWEEN * size
    return distances
