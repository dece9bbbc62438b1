"""Elements as they stand: which of them would run into each other.

Stem and body of an element are taken as two capsules, the points within r of a segment along the normal. Two elements
are in each other's way if any two of their capsules overlap:

    min over s, t in [0, 1] of |a + s d - b - t e|  <  r + r'

which has a closed form (Ericson, Real-time collision detection, 2004, section 5.1.9). The stem's capsule begins at
the tip and has room for it. The plate of a pad or a line is a box (`plates_apart`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, Mask, Point, Points, Weights
from fixture_design.design.candidates import Several
from fixture_design.design.plates_apart import Plates
from fixture_design.layout import Stem

#: Sine of an angle, squared, below which two stems are parallel [-].
_PARALLEL = 1e-12


@dataclass(frozen=True, eq=False)
class Standing:
    """Candidates with their capsules, two each; in nobody's way are those whose radii are -inf.

    Attributes:
        starts, ways: of the segments, from ``starts`` to ``starts + ways`` in W, shape (n, 2, 3) [m].
        radii: shape (n, 2) [m].
        plates: boxes at the tips of those that have one; None where nobody has.
    """

    starts: Several
    ways: Several
    radii: Float[np.ndarray, "n 2"]
    plates: Plates | None = None
    _known: dict[int, Mask] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, feet: Points, normals: Points, stems: Sequence[Stem | None], plates: Plates | None = None) -> Standing:
        """Elements with their stems, along ``normals`` from their feet, shape (n, 3); None for who knows how."""
        sizes = {stem: np.array(_capsules(stem)) for stem in set(stems) if stem is not None}
        none = np.array([(0.0, 1.0, -np.inf)] * 2)
        low, high, radii = np.array([none if stem is None else sizes[stem] for stem in stems]).transpose(2, 0, 1)
        along = normals[:, None]
        return cls(feet[:, None] + low[:, :, None] * along, (high - low)[:, :, None] * along, radii, plates)

    def beside(self, index: int) -> Mask:
        """Which candidates may stand beside one, shape (n,)."""
        if index not in self._known:
            self._known[index] = self._beside(index)
        return self._known[index]

    def free(self, chosen: Indices, pool: Indices) -> Mask:
        """Which of a pool may stand beside all chosen ones."""
        free = np.ones(len(pool), dtype=bool)
        for index in chosen.tolist():
            free &= self.beside(index)[pool]
        return free

    def first_conflict(self, chosen: Indices) -> tuple[int, int] | None:
        """Places in ``chosen`` of two that are in each other's way; None where all may stand together."""
        for place, index in enumerate(chosen.tolist()):
            later = np.flatnonzero(~self.beside(index)[chosen[place + 1 :]])
            if len(later):
                return place, place + 1 + int(later[0])
        return None

    @cached_property
    def _around(self) -> tuple[Points, Weights]:
        """A ball around each element: its middle, and its radius; -inf around what is in nobody's way."""
        middles = self.starts[:, 0] + (self.starts[:, 1] + self.ways[:, 1] - self.starts[:, 0]) / 2
        reach = np.linalg.norm(self.starts[:, 0] - middles, axis=1) + self.radii.max(axis=1)
        if self.plates is not None:
            there = self.plates.there
            away = np.linalg.norm(self.plates.middles - middles, axis=1)
            reach[there] = np.maximum(reach, away + np.linalg.norm(self.plates.halves, axis=(1, 2)))[there]
        return middles, reach

    def _beside(self, index: int) -> Mask:
        middles, reach = self._around
        near = np.flatnonzero(np.linalg.norm(middles - middles[index], axis=1) < reach + reach[index])
        free = np.ones(len(near), dtype=bool)
        for mine in range(2):
            for other in range(2):
                away = segment_distances(
                    self.starts[index, mine], self.ways[index, mine], self.starts[near, other], self.ways[near, other]
                )
                free &= away >= self.radii[index, mine] + self.radii[near, other]
        if self.plates is not None:
            free &= self.plates.apart(index, near, self.starts + self.ways / 2, self.ways / 2, self.radii)
        beside = np.ones(len(self.radii), dtype=bool)
        beside[near[~free]] = False
        beside[index] = True
        return beside


def _capsules(stem: Stem) -> list[tuple[float, float, float]]:
    """From one height above the contact to another, and the radius."""
    column, body = stem.columns
    around_tip = stem.radius if stem.flat else max(stem.radius, stem.tip)
    return [(column.low, column.high, around_tip), (body.low, body.high, body.radius)]


def segment_distances(start: Point, way: Point, starts: Points, ways: Points) -> Weights:
    """The distance from one segment to each of many [m]: from ``start`` to ``start + way``, none of length zero.

    Args:
        start, way: shape (3,).  starts, ways: shape (n, 3).
    """
    away = start - starts
    a, e = float(way @ way), np.einsum("ij,ij->i", ways, ways)
    b, c, f = ways @ way, away @ way, np.einsum("ij,ij->i", ways, away)
    sine = a * e - b * b
    skew = sine > _PARALLEL * a * e
    s = np.where(skew, np.clip((b * f - c * e) / np.where(skew, sine, 1.0), 0.0, 1.0), 0.0)
    t = (b * s + f) / e
    s = np.where(t < 0, np.clip(-c / a, 0.0, 1.0), np.where(t > 1, np.clip((b - c) / a, 0.0, 1.0), s))
    t = np.clip(t, 0.0, 1.0)
    return np.linalg.norm(away + s[:, None] * way - t[:, None] * ways, axis=1)
