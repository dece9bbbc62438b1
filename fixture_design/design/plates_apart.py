"""Plates of pads and lines, and whether they leave room for each other and for what stands beside them.

Boxes and capsules are convex: two are apart if along some direction a their shadows are,

    |(c - c') . a|  >=  sum_k |g_k . a| + sum_k |g'_k . a| + r |a|,

with c their middles, g_k the half edges of a box, or the half segment of a capsule, and r its radius. For boxes the
edges' directions and their cross products are all that have to be tried; for capsules more would be, so that one near
a corner may count as in the way though it just passes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Mask, Point, Points, Weights, cross_products
from fixture_design.design.candidates import Several
from fixture_design.tolerances import DEFAULT


@dataclass(frozen=True, eq=False)
class Plates:
    """A box for each of n elements.

    Attributes:
        middles: shape (n, 3), in W [m].  halves: half edges, shape (n, 3, 3) [m]; zero for elements without a plate.
    """

    middles: Points
    halves: Several

    @cached_property
    def there(self) -> Mask:
        """Which elements have a plate."""
        return np.any(self.halves, axis=(1, 2))

    def apart(
        self, index: int, others: Indices, middles: Several, halves: Several, radii: Float[np.ndarray, "n k"]
    ) -> Mask:
        """Whether one element's plate is clear of others, and of their capsules, and its capsules of their plates.

        Args:
            middles, halves, radii: of all elements' capsules, shape (n, k, 3) and (n, k) [m].
        """
        free, plated = np.ones(len(others), dtype=bool), self.there
        if plated[index]:
            mine = self.middles[index], self.halves[index]
            with_plate = plated[others]
            free[with_plate] &= _apart(*mine, self.middles[others[with_plate]], self.halves[others[with_plate]])
            for capsule in range(radii.shape[1]):
                one = middles[others, capsule], halves[others, capsule, None]
                free &= _apart(*mine, *one, radii[others, capsule])
        theirs = np.flatnonzero(plated[others])
        for capsule in range(radii.shape[1]) if len(theirs) else ():
            one = middles[index, capsule], halves[index, capsule, None]
            plates = self.middles[others[theirs]], self.halves[others[theirs]]
            free[theirs] &= _apart(*one, *plates, np.full(len(theirs), radii[index, capsule]))
        return free


def _apart(middle: Point, halves: Points, middles: Points, others: Several, radii: Weights | None = None) -> Mask:
    """Whether some direction parts one solid from each of m, by `radii` at least: shape (m,).

    Args:
        halves: of the one, shape (j, 3).  others: of the m, shape (m, k, 3); none of them is zero.
    """
    mine = np.broadcast_to(halves, (len(middles), *halves.shape))
    units, their_units = _units(mine), _units(others)
    crossing = cross_products(units[:, :, None], their_units[:, None]).reshape(len(middles), -1, 3)
    axes = np.concatenate([units, their_units, crossing], axis=1)
    lengths = np.linalg.norm(axes, axis=2)
    reach = np.abs(axes @ mine.transpose(0, 2, 1)).sum(axis=2) + np.abs(axes @ others.transpose(0, 2, 1)).sum(axis=2)
    if radii is not None:
        reach = reach + radii[:, None] * lengths
    away = np.abs(np.einsum("mad,md->ma", axes, middles - middle))
    return np.any((away >= reach) & (lengths > DEFAULT.near), axis=1)  # edges along each other give no direction


def _units(vectors: Several) -> Several:
    return vectors / np.linalg.norm(vectors, axis=2, keepdims=True)
