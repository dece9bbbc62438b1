"""Pairs of two edges that cross (3-3, 3-5)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from fixture_design.arrays import Indices, cross_products
from fixture_design.assembly.triples import components_first, cross, dot, rate, turned
from fixture_design.tolerances import APART, ROUND_OFF, SUM_ROUNDING

Space = Float[np.ndarray, "_ 3"]

#: Sine of the angle below which two edges are parallel and have no common normal [-].
PARALLEL = 1e-6

#: What rounding of a pose leaves of the place of a point, relative to the size [-].
_POSE_ROUNDING = 8 * ROUND_OFF


class _TwoLines(NamedTuple):
    """Two edges at n poses, vectors (3, n): unit t along the moving and s along the fixed one.

    Attributes:
        arm: to the moving edge's first end.  away: from the fixed edge's first end to it.  common: t X s.
        sine: its length.  along: how far the nearest points are from the first ends.  lengths: of the edges.
    """

    arm: np.ndarray
    t: np.ndarray
    s: np.ndarray
    away: np.ndarray
    common: np.ndarray
    sine: np.ndarray
    along: tuple[np.ndarray, np.ndarray]
    lengths: tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True, eq=False)
class EdgePairs:
    """Every edge across every other, in the order of the moving edges.

    Attributes:
        my_edges, their_edges: their ends, shapes (a, 2, 3) and (b, 2, 3), in the moving frame and in W.
        their_outward: shape (b, 3), out of the fixed body at its edges: tells which way the gap counts.
    """

    my_edges: Float[np.ndarray, "_ 2 3"]
    their_edges: Float[np.ndarray, "_ 2 3"]
    their_outward: Space

    @cached_property
    def mine(self) -> np.ndarray:
        """The moving edge of each pair, shape (p, 2, 3)."""
        return np.repeat(self.my_edges, len(self.their_edges), axis=0)

    @cached_property
    def theirs(self) -> np.ndarray:
        """The fixed edge of each pair, shape (p, 2, 3)."""
        return np.tile(self.their_edges, (len(self.my_edges), 1, 1))

    def distances(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """H of every pair, shape (n, p) [m]: as `equations`, by products of all edges with all others."""
        begin, end = (self.my_edges[:, k] @ np.swapaxes(R, 1, 2) + position[:, None] for k in range(2))
        start, along = self.their_edges[:, 0], self.their_edges[:, 1] - self.their_edges[:, 0]
        lengths = np.linalg.norm(self.my_edges[:, 1] - self.my_edges[:, 0], axis=1), np.linalg.norm(along, axis=1)
        t, s = (end - begin) / lengths[0][:, None], along / lengths[1][:, None]
        cosine = t @ s.T
        # of the vector from the fixed edge's start to the moving edge's: along s, along t, along t X s
        along_s = begin @ s.T - _dot(start, s)
        along_t = _dot(begin, t)[..., None] - t @ start.T
        triple = cross_products(begin, t) @ s.T - t @ cross_products(s, start).T
        squared = 1.0 - cosine * cosine
        parallel = squared < PARALLEL**2
        squared = np.where(parallel, 1.0, squared)
        here = (cosine * along_s - along_t) / squared, (along_s - cosine * along_t) / squared
        over = [a - np.clip(a, 0.0, most) for a, most in zip(here, (lengths[0][:, None], lengths[1]), strict=True)]
        found = np.sqrt(triple**2 / squared + over[0] ** 2 + over[1] ** 2)
        both = lengths[0][:, None] + lengths[1]
        found = np.where(parallel, both, found).reshape(len(R), len(self.mine))
        # these products tell nearly parallel edges badly: what may be near is looked at again
        near = found <= (APART * self._size + SUM_ROUNDING * both / squared).reshape(len(R), len(self.mine))
        rows, pairs = np.nonzero(near & ~parallel.reshape(len(R), len(self.mine)))
        found[rows, pairs] = self._near(R, position, rows, pairs)
        return found

    def _near(self, R: np.ndarray, position: np.ndarray, rows: Indices, pairs: Indices) -> np.ndarray:
        """H of some pairs at some poses, shape (k,) [m]."""
        lines = self._seen(components_first(R[rows]), components_first(position[rows]), pairs)
        gap = dot(lines.common, lines.away) / lines.sine
        over = [a - np.clip(a, 0.0, most) for a, most in zip(lines.along, lines.lengths, strict=True)]
        found = np.sqrt(gap**2 + over[0] ** 2 + over[1] ** 2)
        # no distance is known better than that: where it is too much, the pair neither touches nor is apart
        hidden = _POSE_ROUNDING * np.maximum(lines.lengths[0] + lines.lengths[1], self._size) / lines.sine
        return np.maximum(found, hidden)

    @cached_property
    def _size(self) -> float:
        return float(np.abs(self.their_edges).max())

    def equations(
        self, R: np.ndarray, position: np.ndarray, chosen: Indices, *, ends: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        """Values (k, n): the gap along the common normal, and how far the crossing is beyond either edge's ends; and
        gradients (k, 6, n); k is 1 without ``ends``.

        Parallel edges have no common normal; they count as far apart, since their ends touch facets.

        Args:
            R: shape (3, 3, n).  position: shape (3, n) [m].  chosen: one pair each, shape (n,).
        """
        lines = self._seen(R, position, chosen)
        parallel, outward = lines.sine < PARALLEL, self.their_outward.T[:, chosen % len(self.their_edges)]
        side = np.where(dot(lines.common, outward) < 0, -1.0, 1.0)
        normal = lines.common * (side / np.where(parallel, 1.0, lines.sine))
        values = [np.where(parallel, lines.lengths[0] + lines.lengths[1], dot(normal, lines.away))]
        rows = [rate(normal, lines.arm + lines.t * lines.along[0])]
        if ends:
            squared = np.where(parallel, 1.0, lines.sine**2)
            for a, length, other in zip(lines.along, lines.lengths, (lines.s, lines.t), strict=True):
                over = np.where(parallel, 0.0, a - np.clip(a, 0.0, length))
                values.append(over)
                rows.append(np.where(over != 0, rate(cross(lines.common, other) / squared, lines.arm), 0.0))
        return np.stack(values), np.stack(rows)

    def _seen(self, R: np.ndarray, position: np.ndarray, chosen: Indices) -> _TwoLines:
        my, their = np.divmod(chosen, len(self.their_edges))
        (begin, t, my_length), (start, s, their_length) = (
            (x[:, rows], unit[:, rows], length[rows])
            for (x, unit, length), rows in zip(self._lines, (my, their), strict=True)
        )
        arm, t = turned(R, begin), turned(R, t)
        away, common = arm + position - start, cross(t, s)
        sine = np.sqrt(dot(common, common))
        # by cross products: 1 - cos^2 and its like lose twice as many digits where lines are nearly parallel
        squared = np.where(sine < PARALLEL, 1.0, sine**2)
        along = -dot(cross(away, s), common) / squared, -dot(cross(away, t), common) / squared
        return _TwoLines(arm, t, s, away, common, sine, along, (my_length, their_length))

    @cached_property
    def _lines(self) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...]:
        """Of both sides' edges the first ends (3, e), the unit vectors along them (3, e), and the lengths."""
        found = []
        for edges in (self.my_edges, self.their_edges):
            along = edges[:, 1] - edges[:, 0]
            lengths = np.linalg.norm(along, axis=1)
            found.append((edges[:, 0].T, (along / lengths[:, None]).T, lengths))
        return tuple(found)

    def beyond(self, R: np.ndarray, position: np.ndarray) -> np.ndarray:
        """How far the crossing is beyond an end of either edge, negative within both, shape (n, p) [m]."""
        arms = np.einsum("nij,pej->npei", R, self.mine)
        t = arms[..., 1, :] - arms[..., 0, :]
        s = np.broadcast_to(self.theirs[None, :, 1] - self.theirs[None, :, 0], t.shape)
        away = arms[..., 0, :] + position[:, None] - self.theirs[None, :, 0]
        tt, ss, ts = _dot(t, t), _dot(s, s), _dot(t, s)
        squared = np.maximum(tt * ss - ts**2, PARALLEL**2 * tt * ss)
        shares = (
            (ts * _dot(s, away) - ss * _dot(t, away)) / squared,
            (tt * _dot(s, away) - ts * _dot(t, away)) / squared,
        )
        lengths = np.sqrt(tt), np.sqrt(ss)
        over = [np.maximum(-share, share - 1) * length for share, length in zip(shares, lengths, strict=True)]
        return np.maximum(*over)

    def arms(self, R: np.ndarray, position: np.ndarray, chosen: np.ndarray) -> np.ndarray:
        """From the moving body's origin to the points of the moving edges next to the fixed ones, (n, m, 3) [m]."""
        ends = np.einsum("nij,nmej->nmei", R, self.mine[chosen])
        t, s = ends[..., 1, :] - ends[..., 0, :], self.theirs[chosen][..., 1, :] - self.theirs[chosen][..., 0, :]
        away = ends[..., 0, :] + position[:, None] - self.theirs[chosen][..., 0, :]
        tt, ss, ts = _dot(t, t), _dot(s, s), _dot(t, s)
        squared = np.maximum(tt * ss - ts**2, PARALLEL**2 * tt * ss)
        share = (ts * _dot(s, away) - ss * _dot(t, away)) / squared
        return ends[..., 0, :] + t * np.clip(share, 0.0, 1.0)[..., None]

    def levers(self, position: np.ndarray) -> np.ndarray:
        longest = np.linalg.norm(self.mine, axis=-1).max(axis=1)
        return np.broadcast_to(longest, (len(position), len(longest)))


def _dot(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", first, second)
